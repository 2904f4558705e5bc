;;; Rational numbers between Lisp and Maxima, their size in powers of two, and as text

(in-package :maxima)

(defun maxima-number (number)
  (if (typep number 'ratio) (list '(rat simp) (numerator number) (denominator number)) number))

(defun rational-of (e)
  "The Lisp rational of a Maxima fraction; what is none stays."
  (if (and (consp e) (eq (caar e) 'rat)) (/ (second e) (third e)) e))

(defun rational-of-bigfloat (e) (times-power-of-two (second e) (- (third e) (car (last (car e))))))
(defun digits-in-bits (digits) (ceiling (* digits (log 10d0 2d0))))
(defun binary-magnitude (x) (- (integer-length (numerator x)) (integer-length (denominator x))))

(defun nearest-integer (value exponent)
  "value/2^exponent, rounded."
  (let ((n (numerator value)) (d (denominator value)))
    (if (minusp exponent) (setq n (ash n (- exponent))) (setq d (ash d exponent)))
    (floor (+ n n d) (+ d d))))

(defun times-power-of-two (integer exponent)
  (cond ((eql integer 0) 0)
        ((minusp exponent) (/ integer (ash 1 (- exponent))))
        (t (ash integer exponent))))

(defun rounded-to-bits (number bits)
  (let ((exponent (- (binary-magnitude number) bits)))
    (times-power-of-two (nearest-integer number exponent) exponent)))

(defun decimal-digits (value digits)
  "A rational, rounded to DIGITS significant decimal digits or one more: \"-123e-2\"."
  (if (eql value 0)
      "0e0"
      (let ((exponent (- (floor (* (binary-magnitude value) (log 2d0 10d0))) digits)))
        (format nil "~de~d" (nearest-integer (* value (expt 10 (- exponent))) 0) exponent))))

(defun $exact_text (number)
  "A rational number: \"-1/3\", \"2\"."
  (let ((value (rational-of number)))
    (format nil "~d~:[/~d~;~]" (numerator value) (eql (denominator value) 1) (denominator value))))

(defun $decimal_text (number digits)
  "A rational number, rounded to DIGITS significant digits: \"-1.23e-4\"."
  (let ((value (rational-of number)))
    (if (eql value 0)
        "0"
        (multiple-value-bind (mantissa exponent) (decimal-parts (abs value) digits)
          (let ((text (format nil "~d" mantissa)))
            (format nil "~:[~;-~]~a.~ae~d" (minusp value) (subseq text 0 1) (subseq text 1)
                    exponent))))))

(defun decimal-parts (value digits)
  "m and e, so that m has that many digits and value = m*10^(e+1-digits)."
  (let ((exponent (floor (* (1- (binary-magnitude value)) (log 2d0 10d0)))))
    (do () ((< value (expt 10 (1+ exponent)))) (incf exponent))
    (let ((mantissa (round (* value (expt 10 (- digits 1 exponent))))))
      (if (eql mantissa (expt 10 digits))
          (values (expt 10 (1- digits)) (1+ exponent))
          (values mantissa exponent)))))

;;; ---- decimals ------------------------------------------------------------------------------

;; Maxima reads a decimal as the floating-point number nearest to it, which is remembered here. Where two decimals have
;; the same, the second one is read as a fraction, as are a bigfloat with more digits than fpprec and what is too large
;; or too small for a floating-point number, up to this power of ten.
(defconstant largest-power 10000)
(defvar *decimals* (make-hash-table) "floating-point number -> the decimal that it was read from")

(unless (get 'make-number 'with-decimals)
  (setf (get 'make-number 'with-decimals) t)
  (let ((read-number (symbol-function 'make-number)))
    (setf (symbol-function 'make-number)
          #'(lambda (parts) (with-decimal (funcall read-number (copy-list parts)) (reverse parts))))))

(defun with-decimal (number parts)
  "The number as it is read, or as a fraction. parts: lists of characters: digits, point, digits, marker, sign, digits."
  (destructuring-bind (whole &optional point digits marker sign power) parts
    (let ((power (if power (parse-integer (coerce (append sign power) 'string)) 0)) (significant (append whole digits)))
      (if (and point (find #\0 significant :test-not #'eql) (< (abs power) largest-power))
          (let ((decimal (* (parse-integer (coerce significant 'string)) (expt 10 (- power (length digits))))))
            (if (if (equal marker '(#\B))
                    (<= (length significant) $fpprec)
                    (and (<= least-positive-normalized-double-float number most-positive-double-float)
                         (eql decimal (or (gethash number *decimals*) (setf (gethash number *decimals*) decimal)))))
                number
                (maxima-number decimal)))
          number))))

(defun $decimal_fraction (x)
  "The decimal that a number was read from, or one of as many digits as it holds that is next to it; or false."
  (multiple-value-bind (value bits)
      (if (floatp x) (values (rational x) 53) (values (rational-of-bigfloat x) (car (last (car x)))))
    (let ((read-from (if (floatp x) (gethash (abs x) *decimals*))))
      (cond (read-from (maxima-number (* (signum value) read-from)))
            ((eql value 0) 0)
            (t (short-decimal value bits))))))

(defun short-decimal (value bits)
  (let ((digits (floor (* bits (log 2d0 10d0)))))
    (multiple-value-bind (mantissa exponent) (decimal-parts (abs value) digits)
      (let ((decimal (* (signum value) mantissa (expt 10 (- (1+ exponent) digits)))))
        (if (<= (abs (- decimal value)) (* (abs value) (expt 2 (- 1 bits)))) (maxima-number decimal))))))
