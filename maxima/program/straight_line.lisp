;;; From the expression graph to a straight-line program
;;;
;;; A node that is used more than once, or would make an expression too long, becomes an assignment.
;;;
;;; Operations are counted on what is written: a sum of k terms takes k-1, a product of k factors k-1, every quotient,
;;; power, root and function call 1. A minus sign of a difference or a number is free; any other takes 1.

(in-package :maxima)

;;; ---- signs ---------------------------------------------------------------------------------
;;;
;;; A program may compute -x for x: a sum is as easily written with all its signs turned. The
;;; signs of products follow from their factors. A sum is turned where that saves a minus sign
;;; standing alone: an output -x, an argument -x, a sum -x - y that has nothing to start with.

(defstruct signs
  (turned (table-of-nodes nil))            ; of a sum, whether its negative is written
  (users (table-of-nodes nil))             ; the nodes that each is part of
  (roots (table-of-nodes nil)))            ; the outputs that each is, as terms

(defun sign-of (node signs)
  "1, or -1 if the negative of the node is what is written."
  (case (node-kind node)
    (opaque (sign-of (node-parts node) signs))
    (sum (if (svref (signs-turned signs) (node-number node)) -1 1))
    (product (let ((sign 1))
               (dolist (factor (node-parts node) sign)
                 (if (oddp (factor-exponent factor))
                     (setq sign (* sign (sign-of (factor-node factor) signs)))))))
    (t 1)))

(defun written-coefficient (term signs) (* (term-coefficient term) (sign-of (term-node term) signs)))
(defun lone-minus-p (term signs) (eql -1 (written-coefficient term signs)))

(defun lone-minuses (place signs)
  "How many minus signs stand alone in a sum, a call or an output."
  (cond ((graph-term-p place) (if (lone-minus-p place signs) 1 0))
        ((eq (node-kind place) 'call) (count-if #'(lambda (term) (lone-minus-p term signs))
                                                (cdr (node-parts place))))
        (t (let ((sign (sign-of place signs)))
             (dolist (term (node-parts place) 1)
               (if (not (eql -1 (* sign (written-coefficient term signs)))) (return 0)))))))

(defun lone-minuses-at (places signs)
  (let ((count 0)) (dolist (place places count) (incf count (lone-minuses place signs)))))

(defun chosen-signs (roots census)
  "Signs for all live nodes: sums are turned, one after the other, where that leaves fewer minus signs alone."
  (let ((signs (make-signs)))
    (dolist (root roots) (push root (svref (signs-roots signs) (node-number (opened-node (term-node root))))))
    (dolist (node (census-nodes census))
      (do-parts (part node) (push node (svref (signs-users signs) (node-number (opened-node part))))))
    (dolist (node (census-nodes census) signs) (if (eq (node-kind node) 'sum) (turn-to-save node signs)))))

(defun turn-to-save (sum signs)
  (let ((places (cons sum (places-above sum signs))))
    (when (plusp (lone-minuses-at places signs))
      (let* ((places (remove-duplicates places)) (before (lone-minuses-at places signs)))
        (turn sum signs)
        (unless (< (lone-minuses-at places signs) before) (turn sum signs))))))

(defun turn (sum signs)
  (let ((number (node-number sum)) (turned (signs-turned signs)))
    (setf (svref turned number) (not (svref turned number)))))

(defun places-above (node signs)
  "The sums, calls and outputs whose terms change sign with the node."
  (let ((places (copy-list (svref (signs-roots signs) (node-number node)))))
    (dolist (user (svref (signs-users signs) (node-number node)) places)
      (if (member (node-kind user) '(sum call))
          (push user places)
          (setq places (nconc (places-above user signs) places))))))

;;; ---- the program under way -------------------------------------------------------------------

(defstruct program prefix census signs
  (length 0)
  (assignments nil)                        ; the last one first
  (operations 0)                           ; in all assignments
  (writings (table-of-nodes nil)))         ; how each is written

(defstruct writing expression (operations 0))

(defvar *longest-inline-writing* 6
  "Operations an expression may have before it gets a name although it is used once.")

(defun $graph_program (outputs prefix)
  "[assignments, outputs, operations] for a list of  [name, term]."
  (let* ((roots (economical-terms (mapcar #'third (cdr outputs))))
         (census (census-of roots))
         (program (make-program :prefix prefix :census census :signs (chosen-signs roots census))))
    (dolist (node (census-nodes census)) (if (named-p node program) (writing-of node program)))
    (let ((variables (mapcar #'(lambda (root) (output-variable root program)) roots)))
      (list '(mlist)
            (cons '(mlist) (reverse (program-assignments program)))
            (cons '(mlist) (mapcar #'(lambda (output variable)
                                       (list '(mlist) (second output) variable))
                                   (cdr outputs) variables))
            (program-operations program)))))

(defun output-variable (term program) (writing-expression (named (writing-of-term term program) program)))

(defun numbered-name (prefix number)
  (intern (concatenate 'string (symbol-name prefix) (princ-to-string number)) :maxima))

(defun named-p (node program)
  (and (shared-p node (program-census program)) (not (eq (node-kind node) 'symbol))))

(defun named (writing program)
  "The writing as a variable; symbols and numbers need none."
  (if (zerop (writing-operations writing))
      writing
      (let ((name (numbered-name (program-prefix program) (incf (program-length program)))))
        (push (list '(mlist) name (writing-expression writing)) (program-assignments program))
        (incf (program-operations program) (writing-operations writing))
        (make-writing :expression name))))

(defun writing-of (node program)
  "How a node, with the sign chosen for it, is written."
  (or (svref (program-writings program) (node-number node))
      (setf (svref (program-writings program) (node-number node))
            (let ((writing (new-writing node program)))
              (if (or (named-p node program)
                      (> (writing-operations writing) *longest-inline-writing*))
                  (named writing program)
                  writing)))))

(defun new-writing (node program)
  (case (node-kind node)
    (symbol (make-writing :expression (node-parts node)))
    (opaque (writing-of (node-parts node) program))
    (sum (sum-writing node program))
    (product (product-writing node program))
    (call (call-writing (node-parts node) program))))

;;; ---- expressions, with their operations --------------------------------------------------------

(defun combined (operator operations writings)
  "The expression  operator(writings), itself some operations; Maxima is to leave it as it is."
  (make-writing :expression (cons (list operator 'simp) (mapcar #'writing-expression writings))
                :operations (+ operations (sum-of-all (mapcar #'writing-operations writings)))))

(defun number-writing (number) (make-writing :expression (maxima-number number)))

(defun writing-of-term (term program)
  (scaled-writing (written-coefficient term (program-signs program)) (term-node term) program))

(defun scaled-writing (coefficient node program)
  (cond ((one-p node) (number-writing coefficient))
        ((eql coefficient 1) (writing-of node program))
        ((eql coefficient -1) (combined 'mminus 1 (list (writing-of node program))))
        (t (combined 'mtimes 1 (list (number-writing coefficient) (writing-of node program))))))

(defun sum-writing (node program)
  "A plus sign first, where there is one; then a number that takes the minus sign."
  (let* ((sign (sign-of node (program-signs program)))
         (terms (mapcar #'(lambda (term)
                            (cons (* sign (written-coefficient term (program-signs program)))
                                  (term-node term)))
                        (node-parts node)))
         (first (or (find-if #'plusp terms :key #'car)
                    (find -1 terms :key #'car :test-not #'eql)
                    (car terms))))
    (combined 'mplus (1- (length terms))
              (cons (scaled-writing (car first) (cdr first) program)
                    (mapcar #'(lambda (term) (summand-writing (car term) (cdr term) program))
                            (remove first terms))))))

(defun summand-writing (coefficient node program)
  (let ((writing (scaled-writing (abs coefficient) node program)))
    (if (minusp coefficient) (combined 'mminus 0 (list writing)) writing)))

(defun product-writing (node program)
  (let ((above (remove-if #'minusp (node-parts node) :key #'factor-exponent))
        (below (remove-if #'plusp (node-parts node) :key #'factor-exponent)))
    (if below
        (combined 'mquotient 1 (list (powers-writing above program) (powers-writing below program)))
        (powers-writing above program))))

(defun powers-writing (factors program)
  (let ((writings (mapcar #'(lambda (factor) (power-writing factor program)) factors)))
    (cond ((null writings) (number-writing 1))
          ((null (cdr writings)) (car writings))
          (t (combined 'mtimes (1- (length writings)) writings)))))

(defun power-writing (factor program)
  (let ((writing (writing-of (factor-node factor) program))
        (exponent (abs (factor-exponent factor))))
    (if (eql exponent 1) writing (combined 'mexpt 1 (list writing (number-writing exponent))))))

(defun call-writing (parts program)
  (let ((writings (mapcar #'(lambda (term) (writing-of-term term program)) (cdr parts))))
    (if (eq (car parts) '%exp)
        (combined 'mexpt 1 (cons (make-writing :expression '$%e) writings))
        (combined (car parts) 1 writings))))
