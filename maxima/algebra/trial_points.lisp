;;; The numbers of trial points (trial_points.mac)

(in-package :maxima)

(defun $mixed_part (i attempt seed) (maxima-number (mixed-part i attempt seed)))

(defun $mixed_parts (size attempt seed)
  "Those of i = 1, 2, ..., size."
  (let ((parts nil))
    (dotimes (i size (mlist-of (nreverse parts))) (push ($mixed_part (1+ i) attempt seed) parts))))

(defun mixed-part (i attempt seed)
  (let ((mixed (+ (* 7919 i) (* 104729 attempt) (* 15485863 seed))))
    (dotimes (k 3) (setq mixed (mod (* 48271 (+ mixed 11)) 2147483647)))
    (/ (mod mixed 1009) 1009)))

(defun $trial_values_near (names centres parts reach positive negative)
  "name = number, around its centre where it has one; else positive for some of them, and of either sign for the
others; all of this negative for the names in the last list."
  (let ((reach (rational-of reach)) (i 0))
    (mlist-of (mapcar #'(lambda (name centre part)
                          (let ((number (trial-value-near (rational-of centre) (rational-of part) reach
                                                    (<= (incf i) positive))))
                            (list '(mequal simp) name
                                  (maxima-number (if (member name (cdr negative)) (- number) number)))))
                      (cdr names) (cdr centres) (cdr parts)))))

;; A thousandth off a known start is far in exact numbers, and Newton's method is quick there.
(defun trial-value-near (centre part reach positive)
  (cond (centre (+ centre (/ (* (- part 1/2) (if (zerop centre) reach (min (abs centre) reach))) 500)))
        (positive (+ 1/2 part))
        (t (- (* 3 part) 3/2))))
