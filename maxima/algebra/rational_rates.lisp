;;; Rational values of expressions and of their rates of change
;;;
;;; A value with its rate is a pair of rationals, (value . rate). Sums, products and whole powers have both as soon as
;;; their symbols have; of other expressions they are not looked for.

(in-package :maxima)

(defun $vanish_with_rates (expressions histories)
  "Whether all expressions and their rates are known to be zero.
HISTORIES are [name, value, rate], or [name, expression] in the names before it."
  (let ((known (make-hash-table)))
    (dolist (history (cdr histories))
      (setf (gethash (second history) known)
            (catch 'no-rational-rate (with-rate-of-history (cddr history) known))))
    (catch 'no-rational-rate
      (all-of-p #'(lambda (e) (let ((found (with-rate e known))) (and (zerop (car found)) (zerop (cdr found)))))
                (cdr expressions)))))

(defun with-rate-of-history (history known)
  (if (cdr history)
      (cons (rational-or-throw (first history)) (rational-or-throw (second history)))
      (with-rate (first history) known)))

(defun rational-or-throw (e)
  (let ((number (rational-of e)))
    (if (rationalp number) number (throw 'no-rational-rate nil))))

(defun with-rate (e known)
  (cond ((symbolp e) (or (gethash e known) (throw 'no-rational-rate nil)))
        ((or (atom e) (eq (caar e) 'rat)) (cons (rational-or-throw e) 0))
        ((eq (caar e) 'mplus) (sum-with-rate (cdr e) known))
        ((eq (caar e) 'mtimes) (product-with-rate (cdr e) known))
        ((and (eq (caar e) 'mexpt) (integerp (third e))) (power-with-rate (with-rate (second e) known) (third e)))
        (t (throw 'no-rational-rate nil))))

(defun sum-with-rate (terms known)
  (let ((value 0) (rate 0))
    (dolist (term terms (cons value rate))
      (let ((found (with-rate term known)))
        (setq value (+ value (car found)) rate (+ rate (cdr found)))))))

(defun product-with-rate (factors known)
  (let ((value 1) (rate 0))
    (dolist (factor factors (cons value rate))
      (let ((found (with-rate factor known)))
        (setq rate (+ (* rate (car found)) (* value (cdr found)))
              value (* value (car found)))))))

(defun power-with-rate (base exponent)
  (if (and (zerop (car base)) (not (plusp exponent))) (throw 'no-rational-rate nil))
  (cons (expt (car base) exponent) (* exponent (expt (car base) (1- exponent)) (cdr base))))
