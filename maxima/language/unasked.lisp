;;; Maxima without its questions
;;;
;;; integrate, is and their like ask for the sign of a symbol, on a terminal or for ever. Here a question
;;; is a failure:  unasked(f)  is [f()], or [] where f() fails or would have asked.

(in-package :maxima)

(defun $unasked (thunk)
  (let ((asking (symbol-function 'retrieve)))
    (unwind-protect
         (progn
           (setf (symbol-function 'retrieve)
                 (lambda (message flag)
                   (declare (ignore message flag))
                   ($refuse '$unanswered_question)))
           (mfuncall '$found_quietly thunk))
      (setf (symbol-function 'retrieve) asking))))
