;;; diff(x, t) in a scene's text: what Maxima takes for a partial derivative
;;;
;;; Maxima takes every symbol for a constant unless  depends  declares otherwise: -c*diff(x, t) is 0, and the
;;; damping is gone. Here  diff  notes what scene text, all that runs outside of the library's functions, differentiates
;;; by t, so that holonomic_system can refuse it; the result is Maxima's own.
;;;
;;; The library's own  diff  takes signum for constant, as it is between its jumps (program/switching.mac).

(in-package :maxima)

(defvar *partial-rates* nil "What scene text has differentiated by t as if it were constant, last first.")
(defvar *plain-diff* (symbol-function '$diff))

(defun $diff (&rest arguments)
  (cond ((not (scene-text-p)) (diff-between-jumps arguments))
        (t (if (and (eq (second arguments) '$t) (constant-by-default-p (first arguments)))
               (push (first arguments) *partial-rates*))
           (apply *plain-diff* arguments))))

(defun diff-between-jumps (arguments)
  (let ((users (get '%signum 'grad)))
    (unwind-protect (progn (setf (get '%signum 'grad) '((x) 0))
                           (apply *plain-diff* arguments))
      (if users (setf (get '%signum 'grad) users) (remprop '%signum 'grad)))))

(defun constant-by-default-p (e)
  "Return true if a symbol of e counts as a constant because  depends  does not declare it."
  (some #'(lambda (symbol) (not (or (eq symbol '$t) (mget symbol 'depends)))) (cdr ($listofvars e))))

(defun scene-text-p ()
  "Whether no function of the library is being called: each call leaves its name on Maxima's stack."
  (notany #'(lambda (entry) (and (symbolp entry) (or (private-symbol-p entry) (public-name-p entry))))
          *mlambda-call-stack*))

(defun $partial_rates ()
  "The list of what scene text has differentiated by t since it was last asked for."
  (prog1 (cons '(mlist) (reverse *partial-rates*)) (setq *partial-rates* nil)))
