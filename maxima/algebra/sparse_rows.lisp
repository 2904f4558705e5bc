;;; Sparse rows: the entries [column, value] of a row that are not zero
;;;
;;; The bordered matrix of A and J,  [A J^T; J 0],  has the rows of both, and right of a row of A its column of J.

(in-package :maxima)

(defun $columns_after (n entries)
  "The entries of columns n+1, n+2, ..., numbered from 1."
  (let ((remaining nil))
    (dolist (entry (cdr entries) (mlist-of (nreverse remaining)))
      (if (> (second entry) n) (push (mlist-of (list (- (second entry) n) (third entry))) remaining)))))

(defun $dense_list (entries size)
  "A list of the terms of columns 1 to size."
  (let ((terms (make-array size :initial-element (number-term 0))))
    (dolist (entry (cdr entries))
      (if (<= (second entry) size) (setf (aref terms (1- (second entry))) (third entry))))
    (mlist-of (coerce terms 'list))))

(defun $rows_without_diagonal (rows)
  (let ((k 0))
    (mlist-of (mapcan #'(lambda (row) (if (member (incf k) (cdr row) :key #'second) nil (list k))) (cdr rows)))))

(defun $positive_diagonal_p (rows)
  "Whether each row of numbers has one entry, on the diagonal and positive."
  (let ((k 0))
    (every #'(lambda (row)
               (incf k)
               (and (cdr row) (null (cddr row))
                    (destructuring-bind (column value) (cdadr row)
                      (and (eql column k) (plusp (rational-of value))))))
           (cdr rows))))

(defun $bordered_rows (rows-of-a rows-of-j)
  (let ((borders (borders-of rows-of-j (length (cdr rows-of-a)))) (s 0))
    (mlist-of (append (mapcar #'(lambda (row) (append row (aref borders (incf s)))) (cdr rows-of-a))
                      (cdr rows-of-j)))))

(defun borders-of (rows n)
  "For each of the n columns, from 1 on, its entries: [n + number of the row, value]."
  (let ((columns (make-array (1+ n) :initial-element nil)) (k (+ n (length (cdr rows)))))
    (dolist (row (reverse (cdr rows)) columns)
      (dolist (entry (cdr row)) (push (mlist-of (list k (third entry))) (aref columns (second entry))))
      (decf k))))

(defun $bordered_neighbours (rows-of-a rows-of-j)
  "A list over the unknowns: the set of those they stand in a row with."
  (let ((k 0))
    (mlist-of (mapcar #'(lambda (row) (cons '($set simp) (remove (incf k) (column-numbers row))))
                      (cdr ($bordered_rows rows-of-a rows-of-j))))))

(defun column-numbers (row) (sort (mapcar #'second (cdr row)) #'<))
