;;; The end of a refusal, in Lisp: what Maxima shows of the calls that led to it ends with the library's own.

(in-package :maxima)

(defun $refuse (id &rest facts)
  "End with the message of a refusal; FACTS take the places of the numbers in it (refusals.mac)."
  ($error (mfuncall '$noted_refusal id (cons '(mlist) facts))))
