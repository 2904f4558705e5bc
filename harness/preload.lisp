;;; Maxima with the library loaded, saved as an image
;;;
;;; GCL interprets what it loads as text. The Lisp functions of the library and of the files that runs are made of are
;;; compiled first, all as one file, where there is a C compiler.

(in-package :maxima)

(defun save-with-library (library &rest jobs)
  "Load the library and the files JOBS, compile their functions, and save this Maxima in a file called image, in the
working directory; another Lisp than GCL saves none."
  #+gcl (progn
          (mfuncall '$load (concatenate 'string library "/holonom.mac"))
          (mfuncall '$load "stringproc")      ; which Maxima looks for and interprets when its first function is called
          (setf (symbol-function 'cl-info::load-primary-index) #'(lambda () nil)) ; it is in the image, too
          (mapc #'load jobs)
          (ignore-errors (load-compiled (functions-of library jobs)))
          (setq *maxima-started* nil *asked-for* nil)
          (si::gbc t)
          (si::save-system "image"))
  (quit))

(defun functions-of (library jobs)
  "The text of all functions that the library, in its namespace, and the files JOBS define in Lisp."
  (with-output-to-string (out)
    (let ((*package* (find-package :maxima)) (*print-pretty* nil))
      (dolist (path (directory (concatenate 'string library "/*/*.lisp")))
        (write-functions (lisp-in-namespace (forms-in path)) out))
      (dolist (path jobs) (write-functions (forms-in path) out)))))

(defun forms-in (path) (with-open-file (in path) (lisp-forms in)))

(defun write-functions (forms out)
  (dolist (form forms)
    (case (first form)
      (defun (if (fboundp (second form)) (format out "~S~%" form)))
      (defstruct (write-constructor (second form) out)))))

(defun write-constructor (structure out)
  "The function that makes a structure, which GCL interprets."
  (let* ((name (intern (format nil "MAKE-~A" (if (consp structure) (first structure) structure))))
         (known (and (fboundp name) (symbol-function name))))
    (if (and (consp known) (eq (second known) name)) (format out "~S~%" (cons 'defun (cdr known))))))

(defun load-compiled (text)
  (with-open-file (out "functions.lisp" :direction :output)
    (format out "(in-package :maxima)~%~A" text))
  #+gcl (progn
          (setq compiler::*opt-two* "-O1" compiler::*opt-three* "-O1") ; as quick as with -O2, and sooner there
          (compile-file "functions.lisp")
          (load "functions.o")))
