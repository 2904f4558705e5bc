;;; Power series on a straight-line program
;;;
;;; Along a motion every value x of the program has derivatives x_0, x_1, x_2, ... at t0. They come order by order, each
;;; value's from those of the values before it (Leibniz):
;;;
;;;     sum        h = c x + d y       h_n = c x_n + d y_n
;;;     product    h = x y             h_n = sum over k = 0 ... n of (n k) x_k y_(n-k)
;;;     quotient   h = x/y             h_n = (x_n - sum over k < n of (n k) h_k y_(n-k))/y_0
;;;     function   h = f(x)            h_n = sum over k < n of (n-1 k) g_k x_(n-k)
;;;     integral   dh/dt = x           h_n = x_(n-1)
;;;
;;; with (n k) = n!/(k! (n-k)!), and g = f'(x), itself a value of the expression graph.
;;;
;;; Numbers are Lisp rationals; t - t0 is measured in units of 1/scale, so that the derivatives are all but whole
;;; numbers. Where numbers are rounded, a series also has mantissas and exponents of two. The sums are a few passes of
;;; `mapcar', which is compiled; this file is loaded as source.

(in-package :maxima)

(defvar *binary-digits* nil
  "Digits that derivatives are rounded to, or nil for exact arithmetic.")

(defvar *scale* 1 "The derivatives are by scale*t.")

;;; All rows run from the highest order down to zero.
(defstruct power-series
  (length 0)                               ; orders 0 ... length-1 are known
  (degree -1)                              ; the last of them that is not zero
  (derivatives nil)
  (mantissas nil)                          ; of the derivatives, where they are rounded
  (exponents nil))

(defun forget-derivatives (x)
  (setf (power-series-length x) 0
        (power-series-degree x) -1
        (power-series-derivatives x) nil
        (power-series-mantissas x) nil
        (power-series-exponents x) nil))

;;; ---- one derivative --------------------------------------------------------------------

(defun derivative (x order) (car (descending (power-series-derivatives x) x order)))

(defun descending (row x order)
  "The items of orders  order ... 0  in a row of the series x."
  (nthcdr (- (power-series-length x) 1 order) row))

(defun ascending (row x first)
  "The items of orders  first ... degree."
  (nthcdr first (reverse (descending row x (power-series-degree x)))))

(defun append-derivative (x value)
  "Makes value, rounded as need be, the derivative of the first order not known yet."
  (push (if *binary-digits* (append-rounded x value) value) (power-series-derivatives x))
  (if (not (eql value 0)) (setf (power-series-degree x) (power-series-length x)))
  (incf (power-series-length x)))

(defvar *exponent-of-zero* -1000000000
  "Below that of any other derivative.")

(defun append-rounded (x value)
  (let* ((exponent (if (eql value 0)
                       *exponent-of-zero*
                       (- (binary-magnitude value) *binary-digits*)))
         (mantissa (if (eql value 0) 0 (nearest-integer value exponent))))
    (push exponent (power-series-exponents x))
    (push mantissa (power-series-mantissas x))
    (times-power-of-two mantissa exponent)))

;;; ---- sums of products ------------------------------------------------------------------

(defvar *binomials* nil "(n 0), (n 1), ..., (n n) for the order n that is being formed.")
(defvar *binomials-before* nil "The same for n-1.")

(defun next-binomials ()
  (setq *binomials-before* *binomials*
        *binomials* (if *binomials*
                        (mapcar #'+ (cons 0 *binomials*) (append *binomials* '(0)))
                        '(1))))

(defun product-derivative (x y n)
  (if (> (power-series-degree x) (power-series-degree y))
      (product-derivative y x n)
      (weighted-products x 0 y n *binomials*)))

(defun quotient-derivative (h x y n)
  "That of h = x/y, while h is known below n."
  (let ((others (if (> (power-series-degree h) (power-series-degree y))
                    (weighted-products y 1 h (1- n) (cdr *binomials*))
                    (weighted-products h 0 y n *binomials*))))
    (/ (- (derivative x n) others) (derivative y 0))))

(defun function-derivative (g x n)
  "That of h with dh = g dx."
  (if (> (power-series-degree g) (power-series-degree x))
      (weighted-products x 1 g (1- n) *binomials-before*)
      (weighted-products g 0 x n *binomials-before*)))

(defun weighted-products (x first y last weights)
  "w_k x_(first+k) y_(last-k), summed over k = 0, 1, ... as far as there are all three."
  (cond ((< (power-series-degree x) first) 0)
        (*binary-digits*
         (sum-of-floats
          (mapcar #'* (ascending (power-series-mantissas x) x first)
                  (descending (power-series-mantissas y) y last)
                  weights)
          (mapcar #'+ (ascending (power-series-exponents x) x first)
                  (descending (power-series-exponents y) y last))))
        (t (sum-of-all (mapcar #'* (ascending (power-series-derivatives x) x first)
                               (descending (power-series-derivatives y) y last)
                               weights)))))

(defun sum-of-floats (mantissas exponents)
  "Without loss down to the last bit of the largest term."
  (let* ((largest (largest-of exponents))
         (shifts (mapcar #'- exponents (make-list (length exponents) :initial-element largest))))
    (times-power-of-two (sum-of-all (mapcar #'ash mantissas shifts)) largest)))

;;; ---- the machine: what is computed at each order -----------------------------------------

(defstruct series-machine
  (definitions (make-hash-table))          ; symbol -> term
  (rates (make-hash-table))                ; symbol -> its time derivative, a term and in the end a series
  (series (make-hash-table))               ; node number -> series
  (steps nil)                              ; list of (series . rule), the last first
  (functions nil)                          ; whose derivatives are still to be looked up
  (outputs nil))                           ; list of (name . series)

(defvar *machine* nil)
(defvar *start* nil "Values at t0: symbol -> rational.")
(defvar *defining* nil "Name of the assignment whose steps are being made.")

(defun $series_machine (definitions rates outputs)
  "The steps that compute all outputs, a list of [name, expression], order by order.
   definitions: [name, expression] in the order in which they can be computed;
   rates: [name, expression], for what starts at a given value and has a given time derivative."
  (let ((*machine* (make-series-machine)))
    (dolist (rate (cdr rates)) (remember-term rate (series-machine-rates *machine*)))
    (dolist (definition (cdr definitions))
      (let ((*defining* (second definition)))
        (series-of-term (remember-term definition (series-machine-definitions *machine*)))))
    (dolist (rate (cdr rates)) (look-up-rate (second rate) (series-machine-rates *machine*)))
    (dolist (output (cdr outputs))
      (push (cons (second output) (series-of-term (expression-term (third output))))
            (series-machine-outputs *machine*)))
    (look-up-derivatives)
    *machine*))

(defun remember-term (pair table) (setf (gethash (second pair) table) (expression-term (third pair))))
(defun look-up-rate (symbol rates) (setf (gethash symbol rates) (series-of-term (gethash symbol rates))))

(defun new-series (rule)
  "Return a series whose coefficients are computed by rule, a function of the series and the order."
  (let ((x (make-power-series)))
    (push (cons x rule) (series-machine-steps *machine*))
    x))

;;; ---- reading the expression graph --------------------------------------------------------

(defun series-of-term (term)
  (if (eql (term-coefficient term) 1)
      (series-of-node (term-node term))
      (sum-series (list term))))

(defun series-of-node (node)
  (let ((known (series-machine-series *machine*)) (number (node-number node)))
    (or (gethash number known)
        (setf (gethash number known)
              (case (node-kind node)
                (symbol (symbol-series (node-parts node)))
                (sum (sum-series (node-parts node)))
                (product (product-series (node-parts node)))
                (call (function-series node (car (node-parts node)) (cdr (node-parts node))))
                (opaque (series-of-node (node-parts node))))))))

(defun symbol-series (symbol)
  (let ((definition (gethash symbol (series-machine-definitions *machine*))))
    (cond (definition (series-of-term definition))
          ((gethash symbol (series-machine-rates *machine*)) (integral-series symbol))
          (t (constant-series #'(lambda () (start-value symbol)))))))

(defun constant-series (value)
  (new-series #'(lambda (h n) (append-derivative h (if (eql n 0) (funcall value) 0)))))

(defun integral-series (symbol)
  (let ((rates (series-machine-rates *machine*)))
    (new-series
     #'(lambda (h n)
         (append-derivative
          h (if (eql n 0)
                (start-value symbol)
                (* *scale* (derivative (gethash symbol rates) (1- n)))))))))

(defun sum-series (terms)
  (let ((factors (mapcar #'term-coefficient terms))
        (parts (mapcar #'(lambda (term) (series-of-node (term-node term))) terms)))
    (new-series
     #'(lambda (h n)
         (append-derivative
          h (sum-of-all (mapcar #'(lambda (c x) (* c (derivative x n))) factors parts)))))))

(defun product-series (factors)
  (let ((above nil) (below nil))
    (dolist (factor factors) (if (plusp (factor-exponent factor)) (push factor above) (push factor below)))
    (if below
        (quotient-of-series (product-of-powers above) (product-of-powers below))
        (product-of-powers above))))

(defun product-of-powers (factors)
  (if (null factors)
      (constant-series #'(lambda () 1))
      (reduce #'product-of-series
              (mapcar #'(lambda (factor)
                          (power-of-series (series-of-node (factor-node factor))
                                           (abs (factor-exponent factor))))
                      factors))))

(defun power-of-series (x exponent)
  (cond ((eql exponent 1) x)
        ((evenp exponent) (power-of-series (product-of-series x x) (/ exponent 2)))
        (t (product-of-series (power-of-series x (1- exponent)) x))))

(defun product-of-series (x y)
  (new-series #'(lambda (h n) (append-derivative h (product-derivative x y n)))))

(defun quotient-of-series (x y)
  (let ((assignment *defining*))
    (new-series
     #'(lambda (h n)
         (if (eql n 0) (require-nonzero (derivative y 0) assignment))
         (append-derivative h (quotient-derivative h x y n))))))

;;; ---- functions ---------------------------------------------------------------------------

(defun function-series (node operator terms)
  (let ((arguments (mapcar #'series-of-term terms)) (gradient nil) (assignment *defining*))
    (push (list node assignment #'(lambda (found) (setq gradient found)))
          (series-machine-functions *machine*))
    (new-series
     #'(lambda (h n)
         (append-derivative
          h (if (eql n 0)
                (function-at-start operator (mapcar #'argument-at-start terms arguments) assignment)
                (sum-of-all (mapcar #'(lambda (g x) (function-derivative g x n)) gradient arguments))))))))

(defun look-up-derivatives ()
  "Partial derivatives of the functions found, whose own functions are found on the way."
  (do () ((null (series-machine-functions *machine*)))
    (destructuring-bind (node *defining* keep) (pop (series-machine-functions *machine*))
      (funcall keep
               (mapcar #'series-of-term
                       (apply (get (car (node-parts node)) 'graph-derivative)
                              (node-term node) (cdr (node-parts node))))))))

;;; ---- values at t0 ------------------------------------------------------------------------

(defun start-value (symbol) (or (gethash symbol *start*) (number-at-start symbol symbol)))

;; A number is not rounded: (-8b0)^(1/3) is -2b0, to a rounded exponent it is complex.
(defun argument-at-start (term x)
  (if (number-term-p term) (maxima-number (term-coefficient term)) (maxima-value (derivative x 0))))

(defun function-at-start (operator arguments assignment)
  (let* ((call (maxima-call operator arguments))
         ($errormsg nil)
         (value (errset (simplifya call nil))))
    (if (or (null value)
            (and (member operator '(mabs %signum)) (zerop1 (car arguments))))
        (obstruction '$singular call assignment))
    (number-at-start (car value) assignment)))

(defun maxima-value (number) (if *binary-digits* ($bfloat (maxima-number number)) (maxima-number number)))

;; exp(-10^7) as a fraction has millions of digits, and its sum with 1 takes minutes.
(defvar *smallest-power* -40000 "Power of two below which rounded values at the initial time are zero.")

(defun number-at-start (e assignment)
  "The value of a Maxima expression as a Lisp rational."
  (let ((value (if *binary-digits* ($bfloat e) e)))
    (cond ((rationalp (rational-of value)) (rational-of value))
          ((bigfloatp value)
           (if (< (- (third value) (car (last (car value)))) *smallest-power*) 0 (rational-of-bigfloat value)))
          (t (obstruction (if *binary-digits* '$not_real '$irrational) e assignment)))))

(defun require-nonzero (value assignment)
  (if (eql value 0) (obstruction '$singular (mfuncall '$division_by_zero) assignment)))

(defun obstruction (kind e assignment)
  "Ends the expansion: what is in its way, the text of it, the assignment it was met in."
  (throw 'obstruction (list '($series_obstruction) kind ($sconcat e) assignment)))

;;; ---- expansion ---------------------------------------------------------------------------

(defun $expand_series (machine start order digits)
  "Coefficients of orders 0 ... order of the machine's outputs: a list of [name, coefficients],
   or series_obstruction(kind, text, name). start: the values [name = value] at t0; digits:
   binary ones, or false for exact numbers. All numbers are returned as integers and fractions."
  (let ((*machine* machine) (*binary-digits* digits) (*defining* nil) (*scale* 1)
        (*start* (make-hash-table)))
    (catch 'obstruction
      (dolist (e (cdr start)) (setf (gethash (second e) *start*) (number-at-start (third e) (second e))))
      (if (null digits) (setq *scale* (suitable-scale)))
      (run-machine order)
      (cons '(mlist)
            (mapcar #'(lambda (output)
                        (list '(mlist) (car output) (maxima-coefficients (cdr output))))
                    (reverse (series-machine-outputs machine)))))))

(defun run-machine (order)
  (let ((steps (reverse (series-machine-steps *machine*))) (*binomials* nil) (*binomials-before* nil))
    (dolist (step steps) (forget-derivatives (car step)))
    (do ((n 0 (1+ n))) ((> n order))
      (next-binomials)
      (dolist (step steps) (funcall (cdr step) (car step) n)))))

(defvar *orders-for-scale* 6)

(defun suitable-scale ()
  "What the denominators of the derivatives gain with an order, seen in a trial."
  (let ((scale 1))
    (run-machine *orders-for-scale*)
    (dolist (step (series-machine-steps *machine*) scale)
      (do ((row (reverse (power-series-derivatives (car step))) (cdr row)))
          ((null (cdr row)))
        (setq scale (lcm scale (/ (denominator (second row))
                                  (gcd (denominator (first row)) (denominator (second row))))))))))

(defun maxima-coefficients (x)
  (let ((unit 1) (n 0))
    (cons '(mlist)
          (mapcar #'(lambda (derivative)
                      (if (plusp n) (setq unit (* unit n *scale*)))
                      (incf n)
                      (maxima-number (/ derivative unit)))
                  (reverse (power-series-derivatives x))))))

;;; ---- two expansions compared --------------------------------------------------------------
;;;
;;; What rounding leaves of a zero shrinks with the digits of the arithmetic: a coefficient that
;;; falls by as many digits as were added, but for a few, is none. The coarser expansion may have come
;;; out smaller by luck, or as zero; then there is none where both are as small as what is left of others,
;;; measured by the largest coefficients of orders around, and smaller by the digits added at least; or where both are
;;; as small, relative to the largest of all orders before, as an error of the initial state, which no digits of the
;;; arithmetic lessen. Coefficients of an entire motion, too, fall below what rounding leaves: where a series fades,
;;; only more digits decide.

(defvar *few-digits* 5)

(defun paired-coefficients (coarse fine)
  "Of each series the list of its coefficients, (coarse . fine)."
  (mapcar #'(lambda (x y)
              (mapcar #'(lambda (a b) (cons (rational-of a) (rational-of b))) (cdr (third x)) (cdr (third y))))
          (cdr coarse) (cdr fine)))

(defun $agreeing_digits (coarse fine added error)
  "Significant decimal digits that all coefficients of two expansions share."
  (let* ((rows (paired-coefficients coarse fine))
         (levels (rounding-levels rows added error))
         (digits most-positive-fixnum))
    (dolist (row rows digits)
      (mapc #'(lambda (pair level)
                (unless (rounded-zero-p pair added level) (setq digits (min digits (shared-digits pair)))))
            row levels))))

(defun $without_rounded_zeros (coarse fine added error)
  "The finer expansion, where rounding has left no zero."
  (let* ((rows (paired-coefficients coarse fine)) (levels (rounding-levels rows added error)))
    (flet ((without-rounding (pair level) (if (rounded-zero-p pair added level) 0 (maxima-number (cdr pair)))))
      (cons '(mlist)
            (mapcar #'(lambda (x row) (list '(mlist) (second x) (cons '(mlist) (mapcar #'without-rounding row levels))))
                    (cdr fine) rows)))))

(defun rounded-zero-p (pair added levels)
  (or (shrinks-p pair added) (and (below-p (car pair) (car levels)) (below-p (cdr pair) (cdr levels)))))

(defun shrinks-p (pair added) (<= (* (abs (cdr pair)) (expt 10 (- added *few-digits*))) (abs (car pair))))
(defun below-p (x level) (or (eql x 0) (and level (<= (binary-magnitude x) level))))

(defun rounding-levels (rows added error)
  "For each order binary magnitudes of what is left of a zero at most, by the coarse and by the fine expansion."
  (let* ((sizes (sizes-by-order rows)) (of-coarse nil) (of-fine nil)
         (few (digits-in-bits *few-digits*)) (most (- (digits-in-bits added)))
         (of-start (if (eql error 0) nil (+ (binary-magnitude (rational-of error)) few))))
    (dolist (row rows)
      (mapc #'(lambda (pair size)
                (when (and (not (eql (car pair) 0)) (not (eql (cdr pair) 0)) (shrinks-p pair added))
                  (setq of-coarse (larger of-coarse (- (binary-magnitude (car pair)) size))
                        of-fine (larger of-fine (- (binary-magnitude (cdr pair)) size)))))
            row sizes))
    (flet ((level (of-zeros size largest)
             (larger (if of-start (+ of-start largest)) (if of-zeros (+ size (min (+ of-zeros few) most))))))
      (mapcar #'(lambda (size largest) (cons (level of-coarse size largest) (level of-fine size largest)))
              sizes (largest-so-far sizes)))))

(defun largest-so-far (sizes)
  (let ((largest nil)) (mapcar #'(lambda (size) (setq largest (larger largest size))) sizes)))

(defun larger (x y) (if (and x y) (max x y) (or x y)))

(defun sizes-by-order (rows)
  "Binary magnitude of the largest coefficient that both expansions know of each order and its two neighbours;
where there is none, of the nearest order before, or else after."
  (let* ((known (reduce #'(lambda (some more) (mapcar #'larger some more))
                        (mapcar #'(lambda (row) (mapcar #'known-magnitude row)) rows)))
         (sizes (mapcar #'(lambda (before here after) (larger before (larger here after)))
                        (cons nil known) known (append (cdr known) '(nil))))
         (last (or (find-if #'identity sizes) 0)))
    (mapcar #'(lambda (size) (setq last (or size last))) sizes)))

(defun known-p (pair) (and (not (eql (cdr pair) 0)) (>= (shared-digits pair) *few-digits*)))
(defun known-magnitude (pair) (if (known-p pair) (binary-magnitude (cdr pair))))

(defun $fading (coarse fine)
  "Whether one of the series ends in what may be zeros of rounding, or coefficients that are smaller than rounding:
more of them in a row than between coefficients that both expansions know."
  (some #'fading-p (paired-coefficients coarse fine)))

(defun fading-p (row)
  (let ((longest 0) (run 0) (begun nil) (rounded nil))
    (dolist (pair row (and begun rounded (> run longest)))
      (if (known-p pair)
          (setq longest (if begun (max longest run) 0) run 0 begun t rounded nil)
          (setq run (1+ run) rounded (or rounded (not (eql (cdr pair) 0))))))))

(defun shared-digits (pair)
  (let ((difference (abs (- (car pair) (cdr pair)))))
    (if (eql difference 0)
        most-positive-fixnum
        (floor (* (log 2d0 10d0) (- (binary-magnitude (cdr pair)) (binary-magnitude difference)))))))
