;;; The same values in fewer operations
;;;
;;; The graph below the wanted outputs is rewritten before it is written down, in passes:
;;;
;;;     shared sums        a + b + c, a + b - d       ->  s = a + b;  s + c, s - d
;;;     factored sums      a*b + a*c                  ->  a*(b + c)
;;;     shared products    a*b/c, a*d/c               ->  p = a/c;  p*b, p*d
;;;
;;; Each pass makes new nodes of the same graph and returns the outputs as terms of them.

(in-package :maxima)

(defun economical-terms (terms)
  "Terms of the same values that take fewer operations together."
  (share-pairs (share-pairs (factor-sums (share-pairs terms 'sum)) 'product) 'sum))

;;; ---- live nodes and their uses -----------------------------------------------------------

(defmacro do-parts ((part node) &body body)
  "Run the body for each node that a node is made of, in order, without a list of them; (return value) ends it."
  (let ((kind (gensym)) (parts (gensym)) (each (gensym)) (own (gensym)))
    `(let* ((,own ,node) (,kind (node-kind ,own)) (,parts (node-parts ,own)))
       (case ,kind
         ((sum product call)
          (dolist (,each (if (eq ,kind 'call) (cdr ,parts) ,parts))
            (let ((,part (if (eq ,kind 'product) (factor-node ,each) (term-node ,each)))) ,@body)))
         (opaque (block nil (let ((,part ,parts)) ,@body)))))))

(defun opened-node (node) (if (eq (node-kind node) 'opaque) (node-parts node) node))

(defstruct census
  nodes                                    ; all live nodes, in order of birth
  (uses (table-of-nodes 0)))               ; how many parts each is

(defun census-of (roots)
  "The nodes that the given terms need, and how often each is used."
  (let ((census (make-census)) (waiting nil) (live nil))
    (dolist (root roots)
      (let ((node (opened-node (term-node root)))) (if (first-use-p node census) (push node waiting))))
    (do () ((null waiting))
      (let ((node (pop waiting)))
        (push node live)
        (do-parts (part node)
          (let ((part (opened-node part))) (if (first-use-p part census) (push part waiting))))))
    (setf (census-nodes census) (in-order-of-birth live))
    census))

(defun in-order-of-birth (nodes)
  (let ((places (table-of-nodes nil)) (ordered nil))
    (dolist (node nodes) (setf (svref places (node-number node)) node))
    (do ((number (1- (length places)) (1- number))) ((minusp number) ordered)
      (if (svref places number) (push (svref places number) ordered)))))

(defun first-use-p (node census) (eql 1 (incf (svref (census-uses census) (node-number node)))))

(defun uses-of (node census)
  "None, of a node that is younger than the census."
  (let ((number (node-number (opened-node node))) (uses (census-uses census)))
    (if (< number (length uses)) (svref uses number) 0)))

(defun shared-p (node census) (> (uses-of node census) 1))

;;; ---- rewriting a graph -------------------------------------------------------------------

(defstruct rewriting
  (done (table-of-nodes nil))              ; the term that each has become
  (parts (table-of-nodes nil))             ; its parts regrouped, where they are
  sum-rule)                                ; (node, its terms rewritten) -> term; nil for their sum

(defun rewritten-terms (terms rewriting nodes)
  "The terms after all nodes they need, given in order of birth, have been rewritten."
  (dolist (node nodes) (rewritten-node node rewriting))
  (mapcar #'(lambda (term) (rewritten-term term rewriting)) terms))

(defun rewritten-term (term rewriting)
  (scaled-term (term-coefficient term) (rewritten-node (term-node term) rewriting)))

(defun rewritten-node (node rewriting)
  (or (svref (rewriting-done rewriting) (node-number node))
      (setf (svref (rewriting-done rewriting) (node-number node))
            (let ((parts (svref (rewriting-parts rewriting) (node-number node))))
              (cond (parts (node-again node parts rewriting))
                    ((and (unruled-p node rewriting) (parts-as-they-were-p node rewriting))
                     (node-term node))
                    (t (node-again node (node-parts node) rewriting)))))))

(defun unruled-p (node rewriting) (not (and (eq (node-kind node) 'sum) (rewriting-sum-rule rewriting))))

(defun parts-as-they-were-p (node rewriting)
  (not (do-parts (part node)
         (let ((term (rewritten-node part rewriting)))
           (if (not (and (eq (term-node term) part) (eql (term-coefficient term) 1))) (return t))))))

(defun node-again (node parts rewriting)
  "A node made anew from its parts rewritten."
  (case (node-kind node)
    (symbol (node-term node))
    (sum (let ((terms (mapcar #'(lambda (term) (rewritten-term term rewriting)) parts)))
           (if (rewriting-sum-rule rewriting)
               (funcall (rewriting-sum-rule rewriting) node terms)
               (sum-of terms))))
    (product (product-of (mapcar #'(lambda (factor)
                                     (power-of (rewritten-node (factor-node factor) rewriting)
                                               (factor-exponent factor)))
                                 parts)))
    (call (call-again (car parts) (mapcar #'(lambda (term) (rewritten-term term rewriting)) (cdr parts))))
    (opaque (opaque-term (rewritten-node parts rewriting)))))

(defun call-again (operator terms)
  (if (and (eq operator 'mexpt) (number-term-p (second terms)))
      (power-of (first terms) (term-coefficient (second terms)))
      (apply #'call-of operator terms)))

;;; ---- factored sums -----------------------------------------------------------------------

(defun factor-sums (roots)
  (let ((census (census-of roots)))
    (rewritten-terms roots
                     (make-rewriting :sum-rule #'(lambda (node terms) (factored-sum node terms census)))
                     (census-nodes census))))

(defun factored-sum (node terms census)
  "Common factors taken out of the terms; a product used elsewhere too stays whole."
  (let ((open nil) (closed nil))
    (mapc #'(lambda (part term)
              (if (shared-p (term-node part) census) (push term closed) (push term open)))
          (node-parts node) terms)
    (if (and (equal terms (node-parts node)) (null (commonest-base open)))
        (node-term node)
        (factored (nreverse open) closed))))

(defun factored (open closed)
  (let ((base (commonest-base open)))
    (if (null base)
        (sum-of (append open closed))
        (let* ((inside (remove-if-not #'(lambda (term) (contains-base-p term base)) open))
               (outside (remove-if #'(lambda (term) (contains-base-p term base)) open))
               (divided (mapcar #'(lambda (term) (divided-by-base term base)) inside))
               (product (product-of (list (factored divided nil) (base-term base)))))
          (factored (cons product outside) closed)))))

;;; A factor is (node . 1) or (node . -1), for a divisor.

(defun base-of-factor (factor) (cons (factor-node factor) (signum (factor-exponent factor))))
(defun base-term (base) (power-of (node-term (car base)) (cdr base)))

(defun contains-base-p (term base)
  (any-of-p #'(lambda (factor)
                (and (eq (factor-node factor) (car base)) (plusp (* (cdr base) (factor-exponent factor)))))
            (factors-of (term-node term))))

(defun divided-by-base (term base)
  (product-of (list term (power-of (node-term (car base)) (- (cdr base))))))

(defun commonest-base (terms)
  "The factor that most of the terms contain, if it is more than one of them."
  (let ((counts nil) (best nil))
    (dolist (term terms)
      (dolist (factor (factors-of (term-node term)))
        (let* ((base (base-of-factor factor))
               (count (assoc base counts :test #'equal)))
          (if count (incf (cdr count)) (push (cons base 1) counts)))))
    (dolist (count counts)
      (if (and (> (cdr count) 1) (or (null best) (> (cdr count) (cdr best)))) (setq best count)))
    (car best)))

;;; ---- shared pairs ------------------------------------------------------------------------
;;;
;;; A sum is a bag of terms, a product a bag of factors. Two members that stand together in
;;; more than one bag, up to a common multiple, become a node of their own; the commonest
;;; pairs first, until no pair is left that stands in two bags.

(defstruct bag node changed members)       ; members: list of (multiplier . node)

(defun share-pairs (roots kind)
  (let* ((census (census-of roots))
         (bags (bags-of kind census)))
    (do () ((not (share-once bags kind census))))
    (let ((rewriting (make-rewriting)))
      (dolist (bag bags)
        (if (bag-changed bag)
            (setf (svref (rewriting-parts rewriting) (node-number (bag-node bag))) (parts-of-bag bag kind))))
      (rewritten-terms roots rewriting (census-nodes census)))))

(defun bags-of (kind census)
  (let ((bags nil))
    (dolist (node (census-nodes census) (nreverse bags))
      (if (eq (node-kind node) kind)
          (let ((members (members-of node kind)))
            (if (cdr members) (push (make-bag :node node :members members) bags)))))))

(defun members-of (node kind)
  (if (eq kind 'sum)
      (mapcar #'(lambda (term) (cons (term-coefficient term) (term-node term))) (node-parts node))
      (mapcan #'repeated-bases (node-parts node))))

(defvar *longest-power-written-out* 3
  "Powers up to this one are taken for repeated factors: x^2*y may share x*y.")

(defun repeated-bases (factor)
  (let ((node (factor-node factor)) (exponent (factor-exponent factor)))
    (if (<= (abs exponent) *longest-power-written-out*)
        (make-list (abs exponent) :initial-element (cons (signum exponent) node))
        (list (cons exponent node)))))

(defun parts-of-bag (bag kind)
  (mapcar #'(lambda (member)
              (if (eq kind 'sum)
                  (make-graph-term :coefficient (car member) :node (cdr member))
                  (make-factor :exponent (car member) :node (cdr member))))
          (bag-members bag)))

(defun share-once (bags kind census)
  "Gives each pair that stands in two bags or more a node; true if there was one."
  (let ((shared nil))
    (dolist (standing (repeated-pairs bags census) shared)
      (if (share-pair standing kind) (setq shared t)))))

;;; A standing is where a pair was found: the bags, and the two members in the first of them.

(defstruct standing bags first second)
(defvar *most-nodes* (expt 2 30))

(defun repeated-pairs (bags census)
  "The standings of all pairs found in two bags or more, the commonest first, among equals the one found last."
  (let ((known (make-hash-table)) (found nil))
    (dolist (bag bags)
      (do ((rest (members-worth-pairing bag census) (cdr rest)))
          ((null rest))
        (dolist (other (cdr rest))
          (let ((standing (standing-of (car rest) other known)))
            (if (null (standing-bags standing)) (push standing found))
            (if (not (eq bag (car (standing-bags standing)))) (push bag (standing-bags standing)))))))
    (stable-sort (delete-if-not #'(lambda (standing) (cdr (standing-bags standing))) found)
                 #'> :key #'(lambda (standing) (length (standing-bags standing))))))

(defvar *largest-bag-to-pair* 40
  "Members a bag may have in common with others: its pairs are as many as their square.")

(defun members-worth-pairing (bag census)
  (let ((common (remove-if #'(lambda (member) (eql 1 (uses-of (cdr member) census)))
                           (bag-members bag))))
    (if (<= (length common) *largest-bag-to-pair*) common)))

(defun standing-of (a b known)
  "Known by one number for both nodes, and by the ratio of the multipliers."
  (let* ((nodes (+ (* (node-number (cdr a)) *most-nodes*) (node-number (cdr b))))
         (ratio (/ (car b) (car a)))
         (standing (cdr (assoc ratio (gethash nodes known)))))
    (or standing
        (cdar (push (cons ratio (make-standing :first a :second b)) (gethash nodes known))))))

(defun share-pair (standing kind)
  (let* ((a (standing-first standing)) (b (standing-second standing))
         (bags (remove-if-not #'(lambda (bag) (multiple-of-pair bag a b)) (standing-bags standing))))
    (when (cdr bags)
      (let* ((pair (pair-term a b kind))
             (others (remove (opened-node (term-node pair)) bags :key #'bag-node)))
        (dolist (bag others others) (put-pair bag a b pair kind))))))

(defun multiple-of-pair (bag a b)
  "What the members a and b are both multiplied by to stand in the bag, if they do."
  (dolist (member (bag-members bag))
    (if (eq (cdr member) (cdr a))
        (let ((multiple (/ (car member) (car a))))
          (if (find-member b multiple (remove member (bag-members bag) :count 1)) (return multiple))))))

(defun find-member (pattern multiple members)
  (find-if #'(lambda (member)
               (and (eq (cdr member) (cdr pattern)) (eql (car member) (* multiple (car pattern)))))
           members))

(defun pair-term (a b kind)
  "The pair as one node not to be opened, as it was found first; 1/(x*y) counts as x*y."
  (opaque-term
   (cond ((eq kind 'sum) (sum-of (list (member-as-term a) (member-as-term b))))
         ((minusp (max (car a) (car b))) (product-of (list (node-term (cdr a)) (node-term (cdr b)))))
         (t (product-of (list (power-of (node-term (cdr a)) (car a))
                              (power-of (node-term (cdr b)) (car b))))))))

(defun member-as-term (member) (scaled-term (car member) (node-term (cdr member))))

(defun put-pair (bag a b pair kind)
  (let* ((multiple (multiple-of-pair bag a b))
         (first (find-member a multiple (bag-members bag)))
         (rest (remove first (bag-members bag) :count 1))
         (second (find-member b multiple rest)))
    (setf (bag-changed bag) t
          (bag-members bag)
          (cons (pair-member a b pair multiple kind) (remove second rest :count 1)))))

(defun pair-member (a b pair multiple kind)
  (cons (cond ((eq kind 'sum) (* multiple (term-coefficient pair)))
              ((minusp (max (car a) (car b))) (- multiple))
              (t multiple))
        (term-node pair)))
