;;; Pivots of a dense matrix of numbers, in fixed-point arithmetic
;;;
;;; Whole multiples of a unit, which the precision and the tolerance decide, replace bigfloats: a determinant of 120
;;; rows and 120 digits takes 1/26 of the time. The entries grow little, as each pivot is the largest of those left.

(in-package :maxima)

(defun $pivot_rows (rows tolerance)
  "Numbers of the rows of the pivots, the largest entry of all first, down to the tolerance times that."
  (let* ((tolerance (exact-number tolerance))
         (bits (+ 32 (max fpprec (* -2 (binary-magnitude tolerance)))))
         (matrix (mapcar #'(lambda (row) (map 'vector #'exact-number (cdr row))) (cdr rows)))
         (largest (reduce #'max (mapcar #'largest-in-row matrix) :initial-value 0)))
    (if (plusp largest)
        (mlist-of (pivots-down-to (floor (* tolerance (ash 1 bits)))
                                  (mapcar #'(lambda (row) (in-fixed-point row (/ (ash 1 bits) largest))) matrix) bits))
        (mlist-of nil))))

(defun exact-number (x)
  (cond ((bigfloatp x) (rational-of-bigfloat x))
        ((floatp x) (rational x))
        (t (rational-of x))))

(defun in-fixed-point (row units) (map 'vector #'(lambda (x) (round (* x units))) row))
(defun largest-in-row (row) (reduce #'max (map 'vector #'abs row) :initial-value 0))

(defun pivots-down-to (threshold rows bits)
  (let* ((left (loop for row in rows for number from 1 collect (list number (largest-in-row row) row))) (pivots nil))
    (loop
      (let ((pivot (if left (reduce #'(lambda (a b) (if (< (second a) (second b)) b a)) left))))
        (if (or (null pivot) (<= (second pivot) threshold)) (return (nreverse pivots)))
        (push (first pivot) pivots)
        (setq left (delete pivot left))
        (let ((column (position (second pivot) (third pivot) :key #'abs)))
          (dolist (other left)
            (eliminate-from (third other) column (third pivot) bits)
            (setf (second other) (largest-in-row (third other)))))))))

(defun eliminate-from (row column pivot bits)
  "row - a multiple of the pivot's row, in place; zero in the column."
  (let ((multiple (if (eql (aref row column) 0) 0 (floor (ash (aref row column) bits) (aref pivot column)))))
    (unless (eql multiple 0)
      (dotimes (k (length row)) (decf (aref row k) (ash (* multiple (aref pivot k)) (- bits)))))
    (setf (aref row column) 0)))
