;;; Maxima's own help knows the library
;;;
;;;   ?holonom\-help(directory)$   takes what `holonom maxima-path` has put into a directory:
;;;
;;;     holonom-index.lisp   what  ?  and  ??  find in holonom.info
;;;     holonom.dem          what  demo(holonom)  runs
;;;     examples.demo        what  example(topic)  runs, in the form of Maxima's manual.demo
;;;
;;; Maxima looks for examples in one file, manual_demo; for a topic of the library that is examples.demo.

(in-package :maxima)

(defvar *examples* nil "The file with the library's examples.")
(defvar *maximas-example* (get '$example 'mfexpr*) "What example(topic) does without the library.")

(defun holonom-help (directory)
  (setq *examples* (concatenate 'string directory "examples.demo"))
  (setf (get '$example 'mfexpr*) 'example-of-topic)
  (let ((demonstrations (concatenate 'string directory "$$$.dem")))
    (unless (member demonstrations (cdr $file_search_demo) :test #'equal)
      (setq $file_search_demo (append $file_search_demo (list demonstrations)))))
  ($load (concatenate 'string directory "holonom-index.lisp"))
  '$done)

(defun example-of-topic (form)
  (let (($manual_demo (if (library-topic-p (second form)) *examples* $manual_demo)))
    (declare (special $manual_demo))
    (funcall *maximas-example* form)))

(defun library-topic-p (topic)
  (let ((heading (concatenate 'string "&& " ($sconcat topic))))
    (with-open-file (examples *examples*)
      (do ((line (read-line examples nil) (read-line examples nil)))
          ((null line) nil)
        (if (string-equal line heading) (return t))))))
