;;; L D L^T and the two triangular solves, entry by entry     (elimination.mac defines what is computed)
;;;
;;; The matrix is a table: the place of an entry of its upper triangle, counted by columns -> the terms still to be
;;; summed, later what a step leaves there. The right-hand side is a vector, from 1 on, of the same. A step is
;;; [k, neighbours].

(in-package :maxima)

(defun $packed_matrix (rows)
  "The matrix of sparse rows [[column, term], ...]; what is right of the diagonal is not looked at."
  (let ((matrix (make-hash-table)) (k 0))
    (dolist (row (cdr rows) matrix)
      (incf k)
      (dolist (entry (cdr row))
        (if (<= (second entry) k) (put-entry (list (third entry)) matrix (second entry) k))))))

(defun $vector_of_terms (terms)
  (let ((vector (make-array (length terms) :initial-element nil)) (k 0))
    (dolist (term (cdr terms) vector) (setf (aref vector (incf k)) (cdr ($graph_terms term))))))

;; By one number: pairs (k . k) all have the same hash in some Lisps.
(defun place-of-entry (i j) (if (< i j) (+ i (floor (* j (1- j)) 2)) (+ j (floor (* i (1- i)) 2))))
(defun $entry_at (matrix i j) (gethash (place-of-entry i j) matrix))
(defun put-entry (value matrix i j) (setf (gethash (place-of-entry i j) matrix) value))
(defun summed (terms) ($graph_hold (sum-of (mapcar #'expression-term terms))))
(defun minus-product (a b) (product-of (list (number-term -1) (expression-term a) (expression-term b))))

(defun $factor_in_place (matrix steps)
  "Leaves d_k at [k,k] and l_i at [k,i]. Returns the unknown whose pivot is zero, or false."
  (dolist (step (cdr steps) nil)
    (let ((k (second step)))
      (eliminate k (cdr (third step)) matrix)
      (if (zero-term-p ($entry_at matrix k k)) (return k)))))

(defun eliminate (k neighbours matrix)
  (let ((d (summed ($entry_at matrix k k))))
    (put-entry d matrix k k)
    (unless (zero-term-p d)
      (let* ((b (mapcar #'(lambda (i) (summed ($entry_at matrix k i))) neighbours))
             (l (mapcar #'(lambda (b_i) ($graph_hold (quotient-of b_i d))) b)))
        (update-neighbours neighbours b l matrix)
        (mapc #'(lambda (i l_i) (put-entry l_i matrix k i)) neighbours l)))))

(defun update-neighbours (neighbours b l matrix)
  "K_ij - l_i b_j, for each pair of neighbours once."
  (do ((is neighbours (cdr is)) (b b (cdr b)) (l l (cdr l))) ((null is))
    (mapc #'(lambda (j b_j)
              (let ((term (minus-product (car l) b_j)))
                (put-entry (cons term ($entry_at matrix (car is) j)) matrix (car is) j)))
          is b)))

(defun $reduce_right_hand_side (r matrix steps)
  "r_i - l_i r_k; leaves r_k at [k]."
  (dolist (step (cdr steps))
    (let* ((k (second step)) (r_k (summed (aref r k))))
      (setf (aref r k) r_k)
      (dolist (i (cdr (third step))) (push (minus-product ($entry_at matrix k i) r_k) (aref r i))))))

(defun $substitute_back (matrix r steps)
  (dolist (step (reverse (cdr steps)))
    (let ((k (second step)) (terms nil))
      (push (quotient-of (expression-term (aref r k)) ($entry_at matrix k k)) terms)
      (dolist (i (cdr (third step))) (push (minus-product ($entry_at matrix k i) (aref r i)) terms))
      (setf (aref r k) (summed (nreverse terms))))))
