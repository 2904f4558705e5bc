;;; Maxima with the library loaded, saved as an image
;;;
;;; GCL interprets what it loads as text. The Lisp functions of the library and of the files that runs are made of are
;;; compiled first, where there is a C compiler. Those that take terms of the expression graph, which they make
;;; themselves, are compiled apart, without a look at the type of a structure whenever a slot is read.

(in-package :maxima)

(defun save-with-library (library &rest jobs)
  "Load the library and the files JOBS, compile their functions, and save this Maxima in a file called image, in the
working directory; another Lisp than GCL saves none."
  #+gcl (progn
          (mfuncall '$load (concatenate 'string library "/holonom.mac"))
          (mfuncall '$load "stringproc")      ; which Maxima looks for and interprets when its first function is called
          (setf (symbol-function 'cl-info::load-primary-index) #'(lambda () nil)) ; it is in the image, too
          (setf (symbol-function 'si::get-path) #'identity) ; GCL asks three shells where programs are when it starts
          (mapc #'load jobs)
          (ignore-errors (compile-in-two-files (directory (concatenate 'string library "/*/*.lisp"))
                                               (append (directory (concatenate 'string library "/*.lisp")) jobs)))
          (setq *maxima-started* nil *asked-for* nil)
          (si::gbc t)
          (si::save-system "image"))
  (quit))

(defun compile-in-two-files (paths jobs)
  (load-compiled 1 (functions-of (remove-if-not #'of-terms-p paths)))
  (load-compiled 2 (concatenate 'string (functions-of (remove-if #'of-terms-p paths))
                                (text-of-functions (mapcan #'forms-in jobs)))))

(defun of-terms-p (path)
  (or (equal (pathname-name path) "expression_graph") (equal (car (last (pathname-directory path))) "program")))

(defun functions-of (paths)
  "The text of all functions that files of the library, in its namespace, define in Lisp."
  (text-of-functions (lisp-in-namespace (mapcan #'forms-in paths))))

(defun text-of-functions (forms)
  (with-output-to-string (out)
    (let ((*package* (find-package :maxima)) (*print-pretty* nil)) (write-functions forms out))))

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

(defun load-compiled (safety text)
  "Load the functions of a text, compiled with that level of checks; 2 is GCL's own."
  (with-open-file (out "functions.lisp" :direction :output :if-exists :supersede)
    (format out "(in-package :maxima)~%(proclaim '(optimize (safety ~D)))~%~A" safety text))
  #+gcl (progn
          (setq compiler::*opt-two* "-O1" compiler::*opt-three* "-O1") ; as quick as with -O2, and sooner there
          (compile-file "functions.lisp")
          (load "functions.o")))
