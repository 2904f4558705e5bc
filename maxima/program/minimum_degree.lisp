;;; Minimum degree                                            (Tinney & Walker 1967, scheme 2)
;;;
;;; Of the unknowns that wait for nothing the one with fewest neighbours is eliminated, of several the first; its
;;; neighbours become neighbours of each other. An unknown is put into a heap whenever its number of neighbours changes,
;;; and what is true of it no more is skipped when it comes up.

(in-package :maxima)

(defstruct ordering
  met                                      ; unknown -> its neighbours, ascending
  awaited                                  ; unknown -> what it waits for
  ranks                                    ; unknown -> where it stands in the heap; nil where it does not
  size n handicap
  (heap nil))

(defun $elimination_steps (neighbours waits n handicap)
  "The steps, [unknown, neighbours left]. Unknowns 1..n go by their number of neighbours, those
after n by that plus handicap; each waits for the neighbours in its set, and for one after n where
`constraint' is in it."
  (let* ((size (length (cdr neighbours)))
         (ordering (make-ordering :met (by-number neighbours) :awaited (by-number waits)
                                  :ranks (make-array (1+ size) :initial-element nil)
                                  :size size :n n :handicap handicap))
         (steps nil))
    (dotimes (i size) (stand-in-line (1+ i) ordering))
    (dotimes (i size (mlist-of (nreverse steps)))
      (let ((k (first-in-line ordering)))
        (push (mlist-of (list k (mlist-of (aref (ordering-met ordering) k)))) steps)
        (leave-neighbours k ordering)))))

(defun by-number (sets) (coerce (cons nil (mapcar #'cdr (cdr sets))) 'vector))

(defun stand-in-line (i ordering)
  (if (null (aref (ordering-awaited ordering) i))
      (let* ((neighbours (length (aref (ordering-met ordering) i)))
             (key (if (> i (ordering-n ordering)) (+ neighbours (ordering-handicap ordering)) neighbours))
             (rank (+ (* key (1+ (ordering-size ordering))) i)))
        (setf (aref (ordering-ranks ordering) i) rank
              (ordering-heap ordering) (melded (make-heap :least rank) (ordering-heap ordering))))))

(defun first-in-line (ordering)
  (do () (nil)
    (let ((heap (ordering-heap ordering)))
      (if (null heap) ($refuse '$no_elimination_order))
      (setf (ordering-heap ordering) (melded (heap-left heap) (heap-right heap)))
      (let ((k (mod (heap-least heap) (1+ (ordering-size ordering)))))
        (when (eql (aref (ordering-ranks ordering) k) (heap-least heap))
          (setf (aref (ordering-ranks ordering) k) nil)
          (return k))))))

(defun leave-neighbours (k ordering)
  (let* ((met (ordering-met ordering)) (awaited (ordering-awaited ordering)) (nearby (aref met k)))
    (dolist (i nearby)
      (setf (aref met i) (delete k (delete i (united (aref met i) nearby)))
            (aref awaited i) (remove (if (> k (ordering-n ordering)) '$constraint k) (aref awaited i)))
      (stand-in-line i ordering))))

(defun united (a b)
  "The numbers of two ascending lists, ascending."
  (let ((all nil))
    (dolist (i (merge 'list (copy-list a) (copy-list b) #'<) (nreverse all))
      (if (not (eql i (car all))) (push i all)))))

;;; ---- leftist heaps (Crane 1972) --------------------------------------------------------
;;;
;;; The shorter way down is always the one to the right, and no longer than the logarithm of the size.

(defstruct heap least (left nil) (right nil) (way-down 1))

(defun melded (a b)
  "The heap of all that is in two."
  (cond ((null a) b)
        ((null b) a)
        ((< (heap-least b) (heap-least a)) (melded b a))
        (t (let ((left (heap-left a)) (right (melded (heap-right a) b)))
             (if (< (way-down left) (way-down right)) (rotatef left right))
             (make-heap :least (heap-least a) :left left :right right :way-down (1+ (way-down right)))))))

(defun way-down (heap) (if heap (heap-way-down heap) 0))
