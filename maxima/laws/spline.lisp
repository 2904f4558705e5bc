;;; The cubic polynomials of a spline, from the points that it runs through       (table.mac)
;;;
;;; The tridiagonal system for the second derivatives is eliminated from the first row, then back. Times are fractions,
;;; heights may be other constants. With few points the solution is exact, but for fractions of more than spline_digits
;;; digits, which are rounded; with many it is computed in integers, multiples of a small unit, which is forty times as
;;; quick.

(in-package :maxima)

(defvar *few-points* 64 "Up to which the solution is exact.")

(defun $spline_curvatures (rows ends)
  "Second time derivatives at the points; ENDS is false, or the list of the slopes at both ends."
  (let* ((times (mapcar #'(lambda (row) (rational-of (second row))) (cdr rows)))
         (h (mapcar #'- (cdr times) times))
         (clamped (if ends 1 0)))
    (funcall (if (<= (length times) *few-points*) #'exact-curvatures #'curvatures-in-units)
             rows
             h
             (append (butlast h) (list (* clamped (car (last h)))))
             (append (list (if ends (* 2 (first h)) 1))
                     (mapcar #'(lambda (before after) (* 2 (+ before after))) h (cdr h))
                     (list (if ends (* 2 (car (last h))) 1)))
             (cons (* clamped (first h)) (cdr h))
             (cdr ends))))

;;; LOWER's k-th number stands in row k + 1 of the matrix, UPPER's in row k.

(defun exact-curvatures (rows h lower diagonal upper ends)
  (let* ((heights (mapcar #'(lambda (row) (rational-of (third row))) (cdr rows)))
         (slopes (mapcar #'(lambda (h low high) (weighted-sum (/ h) high (- (/ h)) low)) h heights (cdr heights)))
         (right (differences-of-slopes slopes (mapcar #'rational-of ends)
                                       #'(lambda (before after) (weighted-sum 6 after -6 before)))))
    (cons '(mlist simp)
          (mapcar #'maxima-number
                  (tridiagonal-solution lower diagonal upper right
                                        #'(lambda (x pivot) (of-short-fractions (weighted-sum (/ pivot) x 0 0)))
                                        #'(lambda (x ratio y) (of-short-fractions (weighted-sum 1 x (- ratio) y))))))))

(defun curvatures-in-units (rows h lower diagonal upper ends)
  (let* ((bits (unit-bits rows))
         (heights (mapcar #'(lambda (row) (in-units (third row) bits)) (cdr rows)))
         (slopes (mapcar #'(lambda (h low high) (floor (* (- high low) (denominator h)) (numerator h)))
                         h heights (cdr heights)))
         (right (differences-of-slopes slopes (mapcar #'(lambda (rate) (in-units rate bits)) ends)
                                       #'(lambda (before after) (* 6 (- after before))))))
    (flet ((in-units-of-all (numbers) (mapcar #'(lambda (x) (in-units x bits)) numbers)))
      (cons '(mlist simp)
            (mapcar #'(lambda (units) (maxima-number (/ units (ash 1 bits))))
                    (tridiagonal-solution (in-units-of-all lower) (in-units-of-all diagonal) (in-units-of-all upper)
                                          right
                                          #'(lambda (x pivot) (floor (ash x bits) pivot))
                                          #'(lambda (x ratio y) (- x (ash (* ratio y) (- bits))))))))))

(defun tridiagonal-solution (lower diagonal upper right share less)
  "SHARE is x/y, LESS is x - ratio*y, of numbers of whatever kind."
  (let ((pivots (list (first diagonal))) (rests (list (first right))) (solution nil))
    (mapc #'(lambda (below pivot above side)
              (let ((ratio (funcall share below (first pivots))))
                (push (funcall less pivot ratio above) pivots)
                (push (funcall less side ratio (first rests)) rests)))
          lower (cdr diagonal) upper (cdr right))
    (push (funcall share (first rests) (first pivots)) solution)
    (mapc #'(lambda (above pivot side)
              (push (funcall share (funcall less side above (first solution)) pivot) solution))
          (reverse upper) (cdr pivots) (cdr rests))
    solution))

(defun differences-of-slopes (slopes ends difference)
  "The right side: at the ends zero, or what the slopes there, ENDS, ask for."
  (append (list (if ends (funcall difference (first ends) (first slopes)) 0))
          (mapcar difference slopes (cdr slopes))
          (list (if ends (funcall difference (car (last slopes)) (second ends)) 0))))

;;; ---- the polynomials ---------------------------------------------------------------------------------

(defun $spline_from (rows curvatures time)
  "[points, second derivatives] from the last point that is no later, if any is but the last, and of all after it."
  (let ((rows (cdr rows)) (curvatures (cdr curvatures)) (time (rational-of time)))
    (do () ((or (null (cddr rows)) (> (rational-of (second (second rows))) time)))
      (setq rows (cdr rows) curvatures (cdr curvatures)))
    (list '(mlist simp) (cons '(mlist simp) rows) (cons '(mlist simp) curvatures))))

(defun $first_piece (rows curvatures)
  "[t_k, c0, c1, c2, c3]: from t_k to the next point  c0 + c1 tau + c2 tau^2 + c3 tau^3,  tau = t - t_k."
  (let* ((row (second rows)) (next-row (third rows))
         (begin (rational-of (second row))) (h (- (rational-of (second next-row)) begin))
         (low (rational-of (third row))) (high (rational-of (third next-row)))
         (bend (rational-of (second curvatures))) (next-bend (rational-of (third curvatures)))
         (slope (weighted-sum (/ h) high (- (/ h)) low)))
    (cons '(mlist simp)
          (mapcar #'maxima-number
                  (list begin low
                        (weighted-sum 1 slope (- (/ h 6)) (weighted-sum 2 bend 1 next-bend))
                        (weighted-sum 1/2 bend 0 0)
                        (weighted-sum (/ (* 6 h)) next-bend (- (/ (* 6 h))) bend))))))

(defun $json_pieces (rows curvatures digits)
  "The same of all points but the last, t_k as a fraction, the others as decimals of n digits."
  (let ((bits (unit-bits rows)))
    (cons '($json_array)
          (mapcar #'(lambda (row next-row bend next-bend)
                      (let ((h (- (rational-of (second next-row)) (rational-of (second row)))))
                        (list* '($json_array) ($exact_text (second row))
                               (mapcar #'(lambda (units) (decimal-digits (/ units (ash 1 bits)) digits))
                                       (coefficients-in-units h (in-units (third row) bits)
                                                              (in-units (third next-row) bits)
                                                              (in-units bend bits) (in-units next-bend bits))))))
                  (cdr rows) (cddr rows) (cdr curvatures) (cddr curvatures)))))

(defun coefficients-in-units (h low high bend next-bend)
  (flet ((times-h (x) (floor (* x (numerator h)) (denominator h)))
         (over-h (x) (floor (* x (denominator h)) (numerator h))))
    (list low
          (- (over-h (- high low)) (floor (times-h (+ bend bend next-bend)) 6))
          (floor bend 2)
          (floor (over-h (- next-bend bend)) 6))))

;;; ---- points ----------------------------------------------------------------------------------------------

(defun $pairs_p (rows)
  (and ($listp rows) (all-of-p #'(lambda (row) (and ($listp row) (= (length row) 3))) (cdr rows))))

(defun $point_without_numbers (rows)
  "Return the first point whose time is not a fraction or whose height is not a constant, or false."
  (car (member-if-not #'(lambda (row) (and (rationalp (rational-of (second row)))
                                           (or (rationalp (rational-of (third row))) ($constantp (third row)))))
                      (cdr rows))))

(defun $point_out_of_order (rows)
  "The place of the first point that is not later than the one before; false where there is none."
  (let ((place 1) (found nil))
    (do ((left (cdr rows) (cdr left))) ((or found (null (cdr left))) found)
      (incf place)
      (unless (< (rational-of (second (first left))) (rational-of (second (second left)))) (setq found place)))))

;;; ---- numbers: fractions of Lisp, or constants of Maxima that are none ------------------------------------

(defun weighted-sum (a x b y)
  "a x + b y, with fractions a and b."
  (if (and (rationalp x) (rationalp y))
      (+ (* a x) (* b y))
      (rational-of ($expand (add (mul (maxima-number a) (maxima-number x))
                                  (mul (maxima-number b) (maxima-number y)))))))

(defun of-short-fractions (x)
  (if (and (rationalp x) (> (integer-length (denominator x)) (spline-bits))) (rounded-to-bits x (spline-bits)) x))

(defun spline-bits () (digits-in-bits $spline_digits))

(defun in-units (x bits)
  "The multiple of 2^-BITS that is next below."
  (cond ((integerp x) (ash x bits))
        ((rationalp x) (floor (ash (numerator x) bits) (denominator x)))
        ((eq (caar x) 'rat) (floor (ash (second x) bits) (third x)))
        (t (in-units (mfuncall '$nearest_fraction x) bits))))

(defun unit-bits (rows)
  "What no height and no time loses spline_digits by: cubes of times are divided by."
  (let ((bits 0))
    (dolist (row (cdr rows) (+ (spline-bits) bits))
      (setq bits (max bits (+ (length-in-bits (third row)) (* 3 (length-in-bits (second row)))))))))

(defun length-in-bits (x)
  (cond ((integerp x) (integer-length x))
        ((and (consp x) (eq (caar x) 'rat)) (+ (integer-length (second x)) (integer-length (third x))))
        (t 0)))
