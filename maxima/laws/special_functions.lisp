;;; Special functions in expressions, and the sums of Chebyshev polynomials that programs hold for them
;;;
;;; Coefficients come from values at t_j = cos(pi j/n), j = 0 ... n, the first and the last of each sum halved,
;;;
;;;     c_k = 2/n sum over j of f(t_j) cos(pi j k/n),
;;;
;;; c_n halved too (Trefethen, Approximation Theory and Approximation Practice, chapter 3). All numbers are integers.

(in-package :maxima)

(defvar *special-functions*
  '(%bessel_j %bessel_y %bessel_i %bessel_k %gamma %zeta %erfc %airy_ai %airy_bi %airy_dai %airy_dbi
    %jacobi_sn %jacobi_cn %jacobi_dn mqapply)
  "Those that an expression may apply to the time; mqapply is psi[k](x).")

(defun $special_applications (e)
  "The different outermost applications of special functions, in the order in which they are met."
  (applications-of-any *special-functions* e))

(defun $chebyshev_coefficients (values cosines)
  "Coefficients of orders 0 ... n, integers in the unit of the values: integers f(t_0) ... f(t_n).
cosines: pairs [numerator, denominator] of those of 0, pi/n, 2 pi/n, ... 2 pi - pi/n, one denominator."
  (let* ((f (coerce (cdr values) 'vector)) (n (1- (length f)))
         (table (map 'vector #'second (cdr cosines))) (unit (third (second cosines)))
         (coefficients nil))
    (dotimes (k (1+ n) (cons '(mlist) (nreverse coefficients)))
      (let ((sum 0))
        (dotimes (j (1+ n))
          (let ((term (* (aref f j) (aref table (mod (* j k) (* 2 n))))))
            (incf sum (if (or (eql j 0) (eql j n)) term (* 2 term)))))
        (push (round sum (* unit n (if (or (eql k 0) (eql k n)) 2 1))) coefficients)))))

(defun $hypergeometric_sum (z p q unit)
  "1 + z/(p(0) q(0)) + z^2/(p(0) p(1) q(0) q(1)) + ..., to shares of 1/unit; [a, b] means p(k) = a k + b."
  (let* ((shares (round (* unit (rational-of z)))) (term unit) (sum unit)
         (more-p (rational-of (second p))) (p (rational-of (third p)))
         (more-q (rational-of (second q))) (q (rational-of (third q))))
    (do () ((eql term 0) (maxima-number (/ sum unit)))
      (setq term (round (* term shares) (* unit p q))
            sum (+ sum term)
            p (+ p more-p)
            q (+ q more-q)))))
