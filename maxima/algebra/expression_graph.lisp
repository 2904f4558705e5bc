;;; Expression graph: every value of the motion program, formed once
;;;
;;; A value is a node of a graph; the same value is the same node, however it was come by:
;;;
;;;     symbol   q1, dot(u), %pi                 call   sin(x), atan2(y, x), a^b
;;;     sum      c1*n1 + c2*n2 + ...             opaque a node that is not to be opened again
;;;     product  n1^e1 * n2^e2 * ...
;;;
;;; with numbers c, whole numbers e and nodes n. A number is a coefficient of the node `one', the empty product.
;;; Functions take and return terms, a coefficient times a node: x - y and 2*y - 2*x share their node x - y.
;;;
;;; The constructors collect like terms and like factors; zeros and ones are gone, a sum has no common factor among
;;; its coefficients and starts with a plus sign. Nothing is ever multiplied out.
;;;
;;; Maxima sees terms as opaque values. The graph in use is the value of `expression_graph':
;;; block([expression_graph : new_expression_graph(variables)], ...).
;;;
;;; The file is loaded as source, interpreted; `do', `dolist' and structures are fast there, `loop' is not.

(in-package :maxima)

(defstruct expression-graph
  (nodes (make-hash-table))                ; hash of a description -> list of (description . node)
  (variables (make-hash-table))            ; symbol to differentiate by -> its position
  (one nil)                                ; the empty product, once asked for
  (size 0))

(defstruct node
  number                                   ; order of birth: parts come before the whole
  kind                                     ; symbol, sum, product, call or opaque
  parts                                    ; sum: terms; product: factors; call: (operator . terms)
  (gradient 'unknown))                     ; list of (position . term), once asked for

(defstruct (graph-term (:conc-name term-)) coefficient node) ; Maxima's package grobner has a structure TERM
(defstruct factor node exponent)
(defmvar $expression_graph nil)

(defun $new_expression_graph (variables)
  "An empty graph, whose gradients are by the given list of symbols."
  (let ((graph (make-expression-graph)) (position 0))
    (dolist (v (cdr variables) graph)
      (setf (gethash v (expression-graph-variables graph)) (incf position)))))

(defun node-of (kind parts description)
  "The node so described; a new one where there is none yet."
  (let* ((nodes (expression-graph-nodes $expression_graph))
         (hash (hash-of (cdr description)))
         (known (assoc description (gethash hash nodes) :test #'equal)))
    (if known
        (cdr known)
        (let ((node (make-node :number (incf (expression-graph-size $expression_graph))
                               :kind kind :parts parts)))
          (push (cons description node) (gethash hash nodes))
          node))))

(defun table-of-nodes (value)
  "The value for each node there is, by its number."
  (make-array (1+ (expression-graph-size $expression_graph)) :initial-element value))

;; Lisps hash a list by its first items at most, which are the same for all sums 1 - x, 1 - y, ...
(defun hash-of (description)
  (let ((hash 0))
    (declare (type (unsigned-byte 40) hash))
    (dolist (item description hash)
      (let ((own (if (typep item 'fixnum) item (sxhash item))))
        (declare (fixnum own))
        (setq hash (logand #xFFFFFFFFFF (+ (* 31 hash) (logand #xFFFFFFFFFF own))))))))

;;; ---- numbers and symbols ---------------------------------------------------------------

(defun one ()
  (or (expression-graph-one $expression_graph)
      (setf (expression-graph-one $expression_graph) (node-of 'product nil '(product)))))


(defun number-term (number) (make-graph-term :coefficient number :node (one)))
(defun zero-term-p (term) (zerop (term-coefficient term)))
(defun number-term-p (term) (one-p (term-node term)))
(defun one-p (node) (and (eq (node-kind node) 'product) (null (node-parts node))))
(defun symbol-term (symbol) (node-term (node-of 'symbol symbol (list 'symbol symbol))))
(defun node-term (node) (make-graph-term :coefficient 1 :node node))

(defun scaled-term (number term)
  (if (eql number 1) term (normal-term (* number (term-coefficient term)) (term-node term))))

(defun normal-term (coefficient node)
  (if (zerop coefficient) (number-term 0) (make-graph-term :coefficient coefficient :node node)))

;;; ---- sums ------------------------------------------------------------------------------

(defun sum-of (terms)
  "Sum of a list of terms."
  (let ((collected (collect-like-terms (with-numbers-together terms))))
    (cond ((null collected) (number-term 0))
          ((null (cdr collected)) (car collected))
          (t (sum-with-scale (scale-of-sum collected) collected)))))

(defun with-numbers-together (terms)
  "2*(x + 1) + 3 as 2*x + 2 + 3: sums that contain a number are opened where numbers meet."
  (if (more-than-one-p #'contains-number-p terms)
      (mapcan #'(lambda (term)
                  (if (and (contains-number-p term) (not (number-term-p term)))
                      (multiples (term-coefficient term) (node-parts (term-node term)))
                      (list term)))
              terms)
      terms))

(defun contains-number-p (term)
  (or (number-term-p term)
      (and (eq (node-kind (term-node term)) 'sum) (any-of-p #'number-term-p (node-parts (term-node term))))))

(defun multiples (number terms) (mapcar #'(lambda (term) (scaled-term number term)) terms))

(defun greatest-first (items order)
  "The items, the greatest first; two, as nearly always, are compared once."
  (cond ((null (cdr items)) items)
        ((cddr items) (sort (copy-list items) #'> :key order))
        ((< (funcall order (first items)) (funcall order (second items))) (reverse items))
        (t items)))

(defun collect-like-terms (terms)
  "The terms in the order of their nodes, each node once, none with coefficient zero."
  (let ((collected nil))
    (dolist (term (greatest-first terms #'term-order) collected)
      (if (and collected (eq (term-node term) (term-node (car collected))))
          (push (make-graph-term :coefficient (+ (term-coefficient term)
                                           (term-coefficient (pop collected)))
                           :node (term-node term))
                collected)
          (push term collected))
      (if (zero-term-p (car collected)) (pop collected)))))

(defun term-order (term) (node-number (term-node term)))

(defun scale-of-sum (terms)
  "The magnitude all coefficients share, or 1; with the sign of the first."
  (let* ((first (term-coefficient (car terms)))
         (magnitude (abs first)))
    (dolist (term (cdr terms)) (if (/= magnitude (abs (term-coefficient term))) (setq magnitude 1)))
    (if (minusp first) (- magnitude) magnitude)))

(defun sum-with-scale (scale terms)
  (make-graph-term :coefficient scale :node (sum-node (grouped-by-magnitude (multiples (/ scale) terms)))))

(defun sum-node (terms)
  (node-of 'sum terms
           (cons 'sum (mapcan #'(lambda (term) (list (term-coefficient term) (term-order term))) terms))))

(defun grouped-by-magnitude (terms)
  "2*a + b - 2*c as b + 2*(a - c): one multiplication for terms of like magnitude."
  (let ((magnitudes (shared-magnitudes terms)))
    (if (or (null magnitudes) (all-of-p #'unit-coefficient-p terms))
        terms
        (let ((grouped (remove-if #'(lambda (term) (member (magnitude term) magnitudes)) terms)))
          (dolist (m magnitudes (collect-like-terms grouped))
            (push (sum-of (remove-if-not #'(lambda (term) (eql (magnitude term) m)) terms)) grouped))))))

(defun shared-magnitudes (terms)
  "The magnitudes other than 1 that more than one coefficient has."
  (let ((seen nil) (shared nil))
    (dolist (term terms shared)
      (let ((m (magnitude term)))
        (cond ((eql m 1))
              ((member m seen) (pushnew m shared))
              (t (push m seen)))))))

(defun magnitude (term) (abs (term-coefficient term)))
(defun unit-coefficient-p (term) (eql (magnitude term) 1))

;;; ---- products and powers ---------------------------------------------------------------

(defun product-of (terms)
  "Product of a list of terms."
  (let ((coefficient 1) (factors nil))
    (dolist (term terms)
      (setq coefficient (* coefficient (term-coefficient term))
            factors (append (factors-of (term-node term)) factors)))
    (if (zerop coefficient)
        (number-term 0)
        (scaled-term coefficient (product-of-factors factors)))))

(defun factors-of (node)
  (if (eq (node-kind node) 'product)
      (node-parts node)
      (list (make-factor :node node :exponent 1))))

(defun product-of-factors (factors)
  (let ((collected (collect-like-factors factors)))
    (cond ((and collected (null (cdr collected)) (eql (factor-exponent (car collected)) 1))
           (node-term (factor-node (car collected))))
          ((any-of-p #'openable-p collected) (product-of (mapcar #'opened collected)))
          (t (or (with-root-of-base collected) (node-term (product-node collected)))))))

(defun product-node (factors)
  (node-of 'product factors
           (cons 'product
                 (mapcan #'(lambda (factor) (list (factor-order factor) (factor-exponent factor)))
                         factors))))

(defun collect-like-factors (factors)
  (let ((collected nil))
    (dolist (factor (greatest-first factors #'factor-order) collected)
      (if (and collected (eq (factor-node factor) (factor-node (car collected))))
          (push (make-factor :node (factor-node factor)
                             :exponent (+ (factor-exponent factor) (factor-exponent (pop collected))))
                collected)
          (push factor collected))
      (if (zerop (factor-exponent (car collected))) (pop collected)))))

(defun factor-order (factor) (node-number (factor-node factor)))

(defun openable-p (factor)
  "A power of a root that is a whole power and more: sqrt(x)^3."
  (let ((exponent (root-exponent (factor-node factor))))
    (and exponent (>= (abs (* exponent (factor-exponent factor))) 1))))

(defun opened (factor)
  (let ((node (factor-node factor)))
    (if (openable-p factor)
        (power-of (second (node-parts node)) (* (root-exponent node) (factor-exponent factor)))
        (product-of-factors (list factor)))))

(defun root-exponent (node)
  "p/q of a node x^(p/q), else nil."
  (if (and (eq (node-kind node) 'call) (eq (car (node-parts node)) 'mexpt))
      (let ((exponent (third (node-parts node))))
        (if (number-term-p exponent) (term-coefficient exponent)))))

(defun with-root-of-base (factors)
  "The product with x*x^(-1/2) as x^(1/2), which has a value at x = 0; nil if it has no such factors."
  (dolist (root factors)
    (let* ((exponent (root-exponent (factor-node root)))
           (x (if exponent (second (node-parts (factor-node root)))))
           (base (if x (find (term-node x) factors :key #'factor-node))))
      (if (and base (minusp (* (factor-exponent root) (factor-exponent base))))
          (return (product-of
                   (list (scaled-term (expt (term-coefficient x) (- (factor-exponent base)))
                                      (power-of x (+ (factor-exponent base) (* exponent (factor-exponent root)))))
                         (product-of-factors (remove root (remove base factors))))))))))

(defun raised-factors (node exponent)
  (mapcar #'(lambda (factor)
              (make-factor :node (factor-node factor) :exponent (* exponent (factor-exponent factor))))
          (factors-of node)))

(defun power-of (term exponent)
  "A term to a rational exponent, as whole powers and one root: x^(-3/2) as 1/(x*sqrt(x))."
  (cond ((integerp exponent)
         (scaled-term (expt (term-coefficient term) exponent)
                      (product-of-factors (raised-factors (term-node term) exponent))))
        ((minusp exponent) (power-of (power-of term (- exponent)) -1))
        (t (multiple-value-bind (whole part) (floor exponent)
             (product-of (list (power-of term whole) (root-of term part)))))))

(defun root-of (term exponent)
  "term^exponent for an exponent between 0 and 1; nothing but squares of numbers is drawn out."
  (let ((number (exact-power (term-coefficient term) exponent)))
    (if number
        (scaled-term number (if (one-p (term-node term))
                                (number-term 1)
                                (call-of 'mexpt (node-term (term-node term)) (number-term exponent))))
        (call-of 'mexpt term (number-term exponent)))))

(defun exact-power (number exponent)
  "number^exponent where that is rational, else nil."
  (if (and (rationalp number) (plusp number))
      (let* ((root (denominator exponent))
             (n (exact-root (numerator number) root))
             (d (exact-root (denominator number) root)))
        (and n d (expt (/ n d) (numerator exponent))))))

(defun exact-root (integer root)
  (let ((r ($inrt integer root))) (and (integerp r) (= (expt r root) integer) r)))

(defun quotient-of (a b)
  (if (and (number-term-p b) (not (zero-term-p b)))
      (scaled-term (/ (term-coefficient b)) a)
      (product-of (list a (power-of b -1)))))

;;; ---- calls and opaque nodes --------------------------------------------------------------

(defun call-of (operator &rest terms)
  (node-term (node-of 'call (cons operator terms)
                      (list* 'call operator
                             (mapcan #'(lambda (term)
                                         (list (term-coefficient term) (term-order term)))
                                     terms)))))

(defun maxima-call (operator arguments)
  (if (eq operator '%exp) (list '(mexpt) '$%e (car arguments)) (cons (list operator) arguments)))

(defun opaque-term (term)
  "The same value, but not opened any more: a factor of products as it is."
  (let ((node (term-node term)))
    (if (and (member (node-kind node) '(sum product)) (not (one-p node)))
        (make-graph-term :coefficient (term-coefficient term)
                   :node (node-of 'opaque node (list 'opaque (node-number node))))
        term)))

;;; ---- reading Maxima expressions --------------------------------------------------------

(defvar *arctan2* (if (get '%atan2 'operators) '%atan2 '$atan2)
  "The name under which this Maxima simplifies the function: it changed after 5.47.")

(defun expression-term (e)
  "The term that a Maxima expression denotes."
  (cond ((graph-term-p e) e)
        ((numberp e) (number-term e))
        ((symbolp e) (symbol-term e))
        (t (case (caar e)
             (rat (number-term (/ (second e) (third e))))
             (bigfloat (symbol-term e))
             (mplus (sum-of (mapcar #'expression-term (cdr e))))
             (mtimes (product-of (mapcar #'expression-term (cdr e))))
             (mminus (scaled-term -1 (expression-term (second e))))
             (mquotient (quotient-of (expression-term (second e)) (expression-term (third e))))
             (($atan2 %atan2) (call-term *arctan2* (mapcar #'expression-term (cdr e))))
             (mexpt (exponential-term (second e) (expression-term (third e))))
             ($chebyshev_sum (clenshaw-term (mapcar #'rational-of (cdr (second e))) (expression-term (third e))))
             (t (call-term (caar e) (mapcar #'expression-term (cdr e))))))))

(defun exponential-term (base exponent)
  (cond ((eq base '$%e) (call-of '%exp exponent))
        ((and (number-term-p exponent) (rationalp (term-coefficient exponent)))
         (power-of (expression-term base) (term-coefficient exponent)))
        (t (call-of 'mexpt (expression-term base) exponent))))

(defun call-term (operator terms)
  (let ((reciprocal (assoc operator '((%sec . %cos) (%csc . %sin) (%cot . %tan)
                                      (%sech . %cosh) (%csch . %sinh) (%coth . %tanh))))
        (of-reciprocal (assoc operator '((%asec . %acos) (%acsc . %asin) (%acot . %atan)
                                         (%asech . %acosh) (%acsch . %asinh) (%acoth . %atanh)))))
    (cond (reciprocal (power-of (apply #'call-of (cdr reciprocal) terms) -1))
          (of-reciprocal (call-of (cdr of-reciprocal) (power-of (first terms) -1)))
          ((get operator 'graph-derivative) (apply #'call-of operator terms))
          (t ($refuse '$function_without_program operator)))))

;; Opaque, for a sum that is opened where numbers meet would double with every order.
(defun clenshaw-term (coefficients x)
  "c_0 + c_1 T_1(x) + ... + c_n T_n(x) by Clenshaw's recurrence b_k = c_k + 2 x b_(k+1) - b_(k+2)."
  (let ((b (number-term 0)) (above (number-term 0)))
    (dolist (c (reverse (cdr coefficients)))
      (psetq b (opaque-term (sum-of (list (number-term c) (product-of (list (number-term 2) x b))
                                        (scaled-term -1 above))))
             above b))
    (sum-of (list (number-term (car coefficients)) (product-of (list x b)) (scaled-term -1 above)))))

;;; ---- derivatives -----------------------------------------------------------------------

(defmacro define-derivative (operator arguments &rest partials)
  "Partial derivatives of a function by its arguments, themselves terms."
  `(setf (get ',operator 'graph-derivative)
         #'(lambda (f ,@arguments) (declare (ignorable f ,@arguments)) (list ,@partials))))

(defun one-plus (sign term) (sum-of (list (number-term 1) (scaled-term sign (power-of term 2)))))

(define-derivative %sin (x) (call-of '%cos x))
(define-derivative %cos (x) (scaled-term -1 (call-of '%sin x)))
(define-derivative %tan (x) (one-plus 1 f))
(define-derivative %asin (x) (power-of (one-plus -1 x) -1/2))
(define-derivative %acos (x) (scaled-term -1 (power-of (one-plus -1 x) -1/2)))
(define-derivative %atan (x) (power-of (one-plus 1 x) -1))
(define-derivative %sinh (x) (call-of '%cosh x))
(define-derivative %cosh (x) (call-of '%sinh x))
(define-derivative %tanh (x) (one-plus -1 f))
(define-derivative %asinh (x) (power-of (one-plus 1 x) -1/2))
(define-derivative %acosh (x) (power-of (sum-of (list (power-of x 2) (number-term -1))) -1/2))
(define-derivative %atanh (x) (power-of (one-plus -1 x) -1))
(define-derivative %erf (x)
  (product-of (list (number-term 2)
                    (power-of (symbol-term '$%pi) -1/2)
                    (call-of '%exp (scaled-term -1 (power-of x 2))))))
(define-derivative %exp (x) f)
(define-derivative %log (x) (power-of x -1))
(define-derivative mabs (x) (call-of '%signum x))
(define-derivative %signum (x) (number-term 0))
(define-derivative $atan2 (y x)
  (quotient-of x (sum-of (list (power-of x 2) (power-of y 2))))
  (scaled-term -1 (quotient-of y (sum-of (list (power-of x 2) (power-of y 2))))))
(setf (get '%atan2 'graph-derivative) (get '$atan2 'graph-derivative))
(define-derivative mexpt (a b)
  (if (number-term-p b)
      (scaled-term (term-coefficient b) (power-of a (1- (term-coefficient b))))
      (product-of (list b f (power-of a -1))))
  (if (number-term-p b) (number-term 0) (product-of (list f (call-of '%log a)))))

(defun local-partials (node)
  "Partial derivatives of a node by the nodes it is made of: list of (node . term)."
  (case (node-kind node)
    (symbol nil)
    (opaque (list (cons (node-parts node) (number-term 1))))
    (sum (mapcar #'(lambda (term) (cons (term-node term) (number-term (term-coefficient term))))
                 (node-parts node)))
    (product (mapcar #'(lambda (factor) (cons (factor-node factor) (partial-by-factor node factor)))
                     (node-parts node)))
    (call (mapcar #'(lambda (term partial)
                      (cons (term-node term) (scaled-term (term-coefficient term) partial)))
                  (cdr (node-parts node))
                  (apply (get (car (node-parts node)) 'graph-derivative)
                         (node-term node) (cdr (node-parts node)))))))

(defun partial-by-factor (product factor)
  (scaled-term (factor-exponent factor)
               (product-of-factors
                (cons (make-factor :node (factor-node factor) :exponent -1) (node-parts product)))))

(defun gradient-of (node)
  "Partial derivatives by the graph's variables: list of (position . term), zeros left out."
  (if (eq (node-gradient node) 'unknown)
      (setf (node-gradient node)
            (if (eq (node-kind node) 'symbol) (symbol-gradient node) (gradient-by-parts node))))
  (node-gradient node))

(defun symbol-gradient (node)
  (let ((position (gethash (node-parts node) (expression-graph-variables $expression_graph))))
    (if position (list (cons position (number-term 1))))))

(defun gradient-by-parts (node)
  "Chain rule, with the products for each variable summed at once."
  (let ((products (make-hash-table :size 16)) (positions nil) (gradient nil))
    (dolist (partial (local-partials node))
      (dolist (entry (gradient-of (car partial)))
        (if (null (gethash (car entry) products)) (push (car entry) positions))
        (push (product-of (list (cdr partial) (cdr entry))) (gethash (car entry) products))))
    (dolist (position positions gradient)
      (let ((derivative (sum-of (gethash position products))))
        (if (not (zero-term-p derivative)) (push (cons position derivative) gradient))))))

;;; A direction gives some symbols a rate of change; all others are constant along it.

(defstruct direction
  (seeds (make-hash-table))                ; symbol -> term
  (rates (make-hash-table)))               ; node number -> term, if known

(defun $graph_direction (equations)
  "The direction in which symbols have the time derivatives given by  symbol = derivative."
  (let ((direction (make-direction)))
    (dolist (e (cdr equations) direction)
      (setf (gethash (second e) (direction-seeds direction)) (expression-term (third e))))))

(defun rate-of (node direction)
  "Derivative of a node in a direction."
  (or (gethash (node-number node) (direction-rates direction))
      (setf (gethash (node-number node) (direction-rates direction))
            (if (eq (node-kind node) 'symbol)
                (or (gethash (node-parts node) (direction-seeds direction)) (number-term 0))
                (rate-by-parts node direction)))))

(defun rate-by-parts (node direction)
  (sum-of (mapcar #'(lambda (partial)
                      (product-of (list (cdr partial) (rate-of (car partial) direction))))
                  (local-partials node))))

;;; ---- what the Maxima side calls ----------------------------------------------------------

(defun $graph_variables () (hash-table-count (expression-graph-variables $expression_graph)))
(defun $graph_term (e) (expression-term e))
(defun $graph_sum (terms) (sum-of (mapcar #'expression-term (cdr terms))))

(defun $graph_terms (term)
  "The terms of a sum, or the one term."
  (let* ((term (expression-term term)) (node (term-node term)))
    (cons '(mlist)
          (if (eq (node-kind node) 'sum)
              (multiples (term-coefficient term) (node-parts node))
              (list term)))))

(defun $graph_product (&rest factors) (product-of (mapcar #'expression-term factors)))
(defun $graph_quotient (a b) (quotient-of (expression-term a) (expression-term b)))
(defun $graph_root (a) (power-of (expression-term a) 1/2))
(defun $graph_sign (a) (call-of '%signum (expression-term a)))

(defun $graph_hold (term)
  "Holds what took a division by more than a symbol; plain products stay open to factoring."
  (if (any-of-p #'computed-factor-p (factors-of (term-node term))) (opaque-term term) term))

(defun computed-factor-p (factor)
  (let ((kind (node-kind (factor-node factor))))
    (or (eq kind 'opaque) (and (minusp (factor-exponent factor)) (not (eq kind 'symbol))))))

(defun $graph_zerop (term) (zero-term-p (expression-term term)))
(defun $graph_numberp (term) (number-term-p (expression-term term)))

;; A sum's own coefficients have no common factor, so that those of the terms decide.
(defun $graph_common_number (terms)
  "The number, as a term, that all of the terms have before them up to the sign; one where they differ."
  (let ((numbers (mapcar #'(lambda (term) (abs (term-coefficient (expression-term term)))) (cdr terms))))
    (number-term (if (and numbers (every #'(lambda (number) (= number (car numbers))) numbers))
                     (car numbers)
                     1))))

(defun $graph_gradient (term)
  "List of  [position, derivative]  for the variables the term contains."
  (cons '(mlist)
        (mapcar #'(lambda (entry)
                    (list '(mlist) (car entry) (scaled-term (term-coefficient term) (cdr entry))))
                (gradient-of (term-node term)))))

(defun $graph_rate (term direction)
  (scaled-term (term-coefficient term) (rate-of (term-node term) direction)))
