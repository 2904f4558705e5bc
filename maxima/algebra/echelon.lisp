;;; Elimination of sparse rows: ranks, kernels and solutions
;;;
;;; A row is a list of entries (column . number) in the order of their columns. It takes its pivot in the column that
;;; fewest rows share.

(in-package :maxima)

(defvar *bits-at-point* (digits-in-bits *digits-at-point*))

(defstruct echelon
  pivots                                   ; list of (column . row), the last first
  dependent)                               ; numbers of the rows that depend on those before them

(defun echelon-in-order (rows)
  "Elimination row by row. Column 0, if there is one, is a right-hand side."
  (let ((rows (coerce rows 'vector)) (i -1))
    (echelon-of rows #'(lambda () (if (< (incf i) (length rows)) i)))))

(defun sparse-echelon (rows)
  "The same in an order that keeps the rows short."
  (let ((rows (coerce rows 'vector))) (echelon-of rows (shortest-first rows))))

(defun shortest-first (rows)
  "A function that gives the number of one of the shortest rows left; a row that gets shorter keeps its place."
  (let ((waiting (make-hash-table)) (length 0) (left (length rows)))
    (do ((i (1- left) (1- i))) ((minusp i)) (push i (gethash (length (aref rows i)) waiting)))
    #'(lambda ()
        (do () ((zerop left) nil)
          (let* ((i (pop (gethash length waiting))) (own (if i (length (aref rows i)))))
            (cond ((null i) (incf length))
                  ((> own length) (push i (gethash own waiting)))
                  (t (decf left) (return i))))))))

(defun echelon-of (rows next-row)
  (let ((holders (make-hash-table)) (done (make-array (length rows) :initial-element nil)) (found (make-echelon)))
    (dotimes (i (length rows)) (dolist (e (aref rows i)) (push i (gethash (car e) holders))))
    (do ((i (funcall next-row) (funcall next-row))) ((null i) found)
      (setf (aref done i) t)
      (let ((pivot (chosen-pivot (aref rows i) holders)))
        (cond ((null pivot) (push (1+ i) (echelon-dependent found)))
              (t (push (cons (car pivot) (aref rows i)) (echelon-pivots found))
                 (eliminate-column pivot i rows holders done)))))))

(defun chosen-pivot (row holders)
  "Of the entries that are not too small in their row, the one that fewest rows share."
  (let ((largest nil) (pivot nil) (fewest nil))
    (dolist (e row)
      (if (plusp (car e)) (setq largest (max (size-in-bits (cdr e)) (or largest (size-in-bits (cdr e)))))))
    (dolist (e row pivot)
      (if (and (plusp (car e)) (>= (+ *pivot-ratio-in-bits* (size-in-bits (cdr e))) largest))
          (let ((count (length (gethash (car e) holders))))
            (if (or (null fewest) (< count fewest)) (setq pivot e fewest count)))))))

(defun eliminate-column (pivot i rows holders done)
  (dolist (k (gethash (car pivot) holders))
    (let ((entry (if (not (aref done k)) (assoc (car pivot) (aref rows k)))))
      (if entry
          (setf (aref rows k)
                (row-less-multiple (aref rows k) (ratio-of (cdr entry) (cdr pivot))
                                   (aref rows i) (car pivot) k holders))))))

(defun row-less-multiple (row multiple other column k holders)
  "row - multiple*other, without the column that vanishes. New entries are passed to the holders."
  (let ((result nil))
    (do () ((and (null row) (null other)) (nreverse result))
      (cond ((or (null other) (and row (< (caar row) (caar other))))
             (push (pop row) result))
            ((or (null row) (< (caar other) (caar row)))
             (push k (gethash (caar other) holders))
             (push (cons (caar other) (less-multiple 0 multiple (cdr (pop other)))) result))
            (t (let* ((e (pop row)) (value (less-multiple (cdr e) multiple (cdr (pop other)))))
                 (if (not (or (= (car e) column) (vanishing-p value))) (push (cons (car e) value) result))))))))

(defun substituted-back (echelon values)
  "Values of the pivots' columns, the others and that of the right-hand side, column 0, given."
  (dolist (pivot (echelon-pivots echelon) values)
    (let ((sum 0) (own nil))
      (dolist (e (cdr pivot))
        (if (eql (car e) (car pivot))
            (setq own (cdr e))
            (incf sum (* (cdr e) (gethash (car e) values 0)))))
      (setf (gethash (car pivot) values) (short-number (/ (- sum) own))))))

(defun $rank_of_rows (rows) (length (echelon-pivots (sparse-echelon (mapcar #'binary-row (rows-from-maxima rows))))))

(defun $independent_rows (rows)
  "Numbers of the rows that do not depend on those before them."
  (mlist-of (independent-rows-of (rows-from-maxima rows))))

(defun independent-rows-of (rows)
  (let ((dependent (echelon-dependent (echelon-in-order (mapcar #'binary-row rows)))))
    (loop for i from 1 to (length rows) unless (member i dependent) collect i)))

(defun $null_vector (rows size)
  "A list x of n numbers, not all of them zero, with  rows . x = 0; false where there is none."
  (if (< ($rank_of_rows rows) size) (null-vector-of (rows-from-maxima rows) size)))

(defun null-vector-of (rows size)
  (let* ((echelon (sparse-echelon rows))
         (bound (make-array (+ size 2) :initial-element nil))
         (values (make-hash-table))
         (open 1))
    (dolist (pivot (echelon-pivots echelon)) (setf (aref bound (car pivot)) t))
    (do () ((not (aref bound open))) (incf open))
    (if (<= open size)
        (let ((x nil))
          (setf (gethash open values) 1)
          (substituted-back echelon values)
          (dotimes (i size (cons '(mlist) (nreverse x)))
            (push (maxima-number (gethash (1+ i) values 0)) x))))))

;;; ---- numbers of a row: rational, floating-point, or binary ---------------------------------
;;;
;;; Each operation on long rationals asks for a greatest common divisor. Where only a rank is wanted, a number is
;;; (mantissa . exponent), of the digits that long rationals are rounded to.

(defvar *pivot-ratio-in-bits* 13 "The largest entry of a row is at most this many bits longer than its pivot.")

(defun binary-row (row)
  (mapcar #'(lambda (e)
              (let ((exponent (- (binary-magnitude (cdr e)) *bits-at-point*)))
                (list* (car e) (nearest-integer (cdr e) exponent) exponent)))
          row))

(defun size-in-bits (x)
  (cond ((consp x) (+ (integer-length (car x)) (cdr x)))
        ((floatp x) (nth-value 1 (decode-float x)))
        (t (binary-magnitude x))))

(defun vanishing-p (x) (and (numberp x) (zerop x)))

(defun ratio-of (a b)
  (if (consp a)
      (let ((bits (integer-length (car b)))) (short-binary (floor (ash (car a) bits) (car b)) (- (cdr a) (cdr b) bits)))
      (short-number (/ a b))))

(defun less-multiple (a multiple b)
  "a - multiple*b, zero where they cancel."
  (if (consp b)
      (let ((product (short-binary (- (* (car multiple) (car b))) (+ (cdr multiple) (cdr b)))))
        (if (eql a 0) product (binary-sum a product)))
      (sum-of-numbers (list a (- (* multiple b))))))

(defun short-binary (mantissa exponent)
  (let ((excess (- (integer-length mantissa) *bits-at-point*)))
    (if (plusp excess) (cons (ash mantissa (- excess)) (+ exponent excess)) (cons mantissa exponent))))

(defun binary-sum (a b)
  (if (< (cdr a) (cdr b)) (rotatef a b))
  (let ((shift (- (cdr a) (cdr b))) (largest (max (size-in-bits a) (size-in-bits b))))
    (if (> shift (* 4 *bits-at-point*))
        a
        (let ((sum (short-binary (+ (ash (car a) shift) (car b)) (cdr b))))
          (if (< (size-in-bits sum) (+ largest (binary-magnitude *zero-share*))) 0 sum)))))
