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

(defun $decimal_fraction (x)
  "The decimal of as many digits as a floating-point number holds, where it is next to one; or false."
  (multiple-value-bind (value bits)
      (if (floatp x) (values (rational x) 53) (values (rational-of-bigfloat x) (car (last (car x)))))
    (if (eql value 0)
        0
        (let ((digits (floor (* bits (log 2d0 10d0)))))
          (multiple-value-bind (mantissa exponent) (decimal-parts (abs value) digits)
            (let ((decimal (* (signum value) mantissa (expt 10 (- (1+ exponent) digits)))))
              (if (<= (abs (- decimal value)) (* (abs value) (expt 2 (- 1 bits)))) (maxima-number decimal))))))))
