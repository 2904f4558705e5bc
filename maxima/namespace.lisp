;;; A namespace for the library
;;;
;;; Maxima has one space of names, and scopes them dynamically. The files of the library are read here: each of their
;;; own names, gradient, is exchanged for a private symbol, gradient', which is displayed and
;;; exported without the prime.
;;;
;;; Unchanged: Maxima's own functions and variables; names that the library neither binds nor calls; the fields
;;; of structures; and the public names: those of public_names(...), the options (names given to define_variable), the
;;; entries of descriptions (named where read_entries is called), the writers of documents (write_...).
;;;
;;;   public_names(name, ...)$              declares names of the vocabulary
;;;   public_steps(name(a, b, [c]), ...)$   declares functions that a user calls as well. The library calls the
;;; private symbols; the plain name checks its arguments first (steps.mac). Those in brackets are given all or none
;;;   private_names(name, ...)$             declares names that head data: json_object(...)
;;;   load_library(directory, [file, ...])$ reads Maxima and Lisp files into the namespace, once
;;;   internal_names();                     lists the names that have a private symbol
;;;   open_namespace()$                     reads from now on everything so: for tests of internal functions
;;;
;;; Names are collected from all files before the first statement is evaluated, so that a name means
;;; one thing in the whole library.

(in-package :maxima)

(defvar *public-names* (make-hash-table :test 'eq) "Names that a user writes.")
(defvar *defined-names* (make-hash-table :test 'eq) "Functions, structures and heads of data.")
(defvar *bound-names* (make-hash-table :test 'eq) "Names that the library binds to values.")
(defvar *read-names* (make-hash-table :test 'eq) "What each name of the library is read as.")
(defvar *steps* nil "The calls of public steps, each as its definition begins: ((name) a b ((mlist) c)).")
(defvar *namespace-open* nil "Whether everything is read as the library's files are.")
(defvar *maxima-package* (find-package :maxima))
(defvar *loaded-from* nil "The lists of files that are loaded, the latest first: (files . directory).")
(defvar *asked-for* nil "Whether a file has loaded the library: it may be there before, in an image.")

;; Maxima orders symbols by the characters that it prints of them, and so all that it simplifies. GCL prints a symbol
;; slower, and into more memory, than it takes to look at its name; GCL 2.7.1, of Debian 13, prints ASCII alone.
#+gcl (defvar *printed-by-maxima* #'print-invert-case)
#+gcl
(defun print-invert-case (x)
  (if (and (symbolp x) (eq (symbol-package x) *maxima-package*))
      (maybe-invert-string-case (symbol-name x))
      (funcall *printed-by-maxima* x)))

(defun note (name table kind)
  (if (maxima-name-p name) (unless (gethash name table) (setf (gethash name table) kind))))

(defun maxima-name-p (x)
  (and (symbolp x) (> (length (symbol-name x)) 1) (char= (char (symbol-name x) 0) #\$)))

;;; ---- whose name it is ------------------------------------------------------------------

(defun public-name-p (name)
  (or (gethash name *public-names*) (starts-with "$write_" (print-invert-case name))))

(defun starts-with (start text)
  (and (>= (length text) (length start)) (string= start (subseq text 0 (length start)))))

(defun maximas-function-p (name)
  (or (fboundp name) (get name 'operators) (get name 'mfexpr*) (get name 'autoload) (get name 'alias)
      (and (mget name 'mexpr) (not (users-function-p name)))))

(defun users-function-p (name) (member name (cdr $functions) :key #'caar))

(defun maximas-variable-p (name)
  (or (nth-value 1 (gethash name *variable-initial-values*)) (get name 'assign) (get name 'sysconst)))

(defun private-name-p (name)
  (and (not (public-name-p name))
       (or (gethash name *defined-names*)
           (and (gethash name *bound-names*)
                (not (maximas-function-p name))
                (not (maximas-variable-p name))))))

(defun private-symbol (name)
  (let ((private (intern (concatenate 'string (symbol-name name) "'") :maxima)))
    (setf (get private 'reversealias) name)
    (setf (get private 'plain-name) name)
    private))

(defun private-symbol-p (name) (and (symbolp name) (get name 'plain-name)))

(defun private-noun (noun)
  "The noun 'f of a private name."
  (let* ((name (get noun 'noun)) (private (read-name name)))
    (if (eq private name)
        noun
        (let ((private ($nounify private)))
          (setf (get private 'reversealias) name)
          private))))

(defun plain-name (name)
  "The name of a private symbol; any other name as it is."
  (or (get name 'plain-name) name))

(defun characters-of-name (name)
  "As the user writes it: Maxima reads  lambda  and  go  as symbols of its own, without the sign before names."
  (let ((characters (maybe-invert-string-case (symbol-name (plain-name (or (get name 'reversealias) name))))))
    (if (member (char characters 0) '(#\$ #\%)) (subseq characters 1) characters)))

(defun read-name (name)
  "What a name is read as: decided once, where it is met first."
  (or (gethash name *read-names*)
      (setf (gethash name *read-names*) (if (private-name-p name) (private-symbol name) name))))

;;; An entry and an internal function may share a name:  kinetic_energy = ...,  kinetic_energy(sys).
(defun read-function-name (name)
  (if (and (eq (gethash name *public-names*) 'entry) (gethash name *defined-names*))
      (private-symbol name)
      (read-name name)))

;;; ---- statements, with the names exchanged ------------------------------------------------

(defun in-namespace (form)
  "A Maxima expression."
  (cond ((symbolp form) (if (maxima-name-p form) (read-name form) form))
        ((or (atom form) (atom (car form))) form)
        ((eq (caar form) '$@) (list (car form) (in-namespace (second form)) (third form)))
        ((eq (caar form) '$defstruct)
         (cons (car form)
               (mapcar #'(lambda (template) (cons (operator-in-namespace (car template)) (cdr template)))
                       (cdr form))))
        (t (cons (operator-in-namespace (car form)) (mapcar #'in-namespace (cdr form))))))

(defun operator-in-namespace (operator)
  (cond ((not (symbolp (car operator))) operator)
        ((get (car operator) 'noun) (cons (private-noun (car operator)) (cdr operator)))
        ((not (maxima-name-p (car operator))) operator)
        ((member 'array operator) (cons (read-name (car operator)) (cdr operator)))
        (t (cons (read-function-name (car operator)) (cdr operator)))))

(defun lisp-in-namespace (form)
  (cond ((maxima-name-p form) (read-name form))
        ((atom form) form)
        (t (cons (lisp-in-namespace (car form)) (lisp-in-namespace (cdr form))))))

;;; ---- what the library binds, calls and asks of a user --------------------------------------

(defun collect-names (form)
  "Notes the names of a Maxima statement."
  (unless (or (atom form) (atom (car form)))
    (let ((operator (caar form)) (arguments (cdr form)))
      (case operator
        ((mdefine mdefmacro $define) (collect-definition (car arguments)))
        ((lambda mprog) (collect-bound (car arguments)))
        (msetq (collect-bound (car arguments)))
        ((mdo mdoin) (collect-bound (car arguments)))
        (($makelist $sum $product $lsum %makelist %sum %product %lsum) (collect-bound (second arguments)))
        ($create_list (collect-every-other (cdr arguments)))
        ($define_variable (note (car arguments) *public-names* 'option)
                          (note (third arguments) *public-names* 'type)
                          (mapc #'collect-entries (cdr arguments)))
        ($read_entries (mapc #'collect-entries arguments))
        ($defstruct (mapc #'(lambda (template) (note (caar template) *defined-names* t)) arguments))))
    (dolist (part (cdr form)) (if (consp part) (collect-names part)))))

(defun collect-definition (head)
  "The function and the parameters of  f(x, [rest]) := ..., or  f[x] := ..."
  (unless (atom head)
    (note (caar head) *defined-names* t)
    (mapc #'collect-bound (cdr head))))

(defun collect-bound (target)
  "A variable, or a list of variables, some perhaps with a value: v, [v, w : e], 'v."
  (cond ((atom target) (note target *bound-names* t))
        ((member (caar target) '(mlist mquote)) (mapc #'collect-bound (cdr target)))
        ((eq (caar target) 'msetq) (collect-bound (second target)))
        ((member 'array (car target)) (note (caar target) *bound-names* t))))

(defun collect-every-other (arguments)
  (do ((left arguments (cddr left))) ((null left)) (collect-bound (car left))))

(defun collect-entries (form)
  "The words quoted in a description of what there is to choose from."
  (cond ((or (atom form) (atom (car form))))
        ((eq (caar form) 'mquote) (note (second form) *public-names* 'entry))
        (t (mapc #'collect-entries (cdr form)))))

(defun collect-lisp-names (form)
  "Notes the Maxima functions and variables that a Lisp form defines."
  (when (and (consp form) (consp (cdr form)))
    (case (car form)
      ((defun defmacro defmfun defmspec)
       (unless (maximas-function-p (second form)) (note (second form) *defined-names* t)))
      ((defvar defmvar defparameter) (note (second form) *defined-names* t)))))

;;; ---- files -------------------------------------------------------------------------------

(defstruct library-file path forms)
(defun lisp-file-p (path) (string= (pathname-type path) "lisp"))

(defun read-library-file (path)
  "The statements of a file, their names collected."
  (with-input-from-string (stream (text-of-file path)) ; Maxima's reader takes three times as long on a file
    (let ((forms (if (lisp-file-p path) (lisp-forms stream) (maxima-statements stream))))
      (mapc (if (lisp-file-p path) #'collect-lisp-names #'collect-names) forms)
      (make-library-file :path path :forms forms))))

(defun text-of-file (path)
  (with-open-file (stream path)
    (let ((text (make-string (file-length stream)))) (subseq text 0 (read-sequence text stream)))))

(defun lisp-forms (stream)
  (let ((*package* (find-package :maxima)))
    (do ((form (read stream nil stream) (read stream nil stream)) (forms nil (cons form forms)))
        ((eq form stream) (nreverse forms)))))

(defun maxima-statements (stream)
  (let ((*mread-prompt* "") (*read-base* 10.) (*namespace-open* nil))
    (declare (special *mread-prompt*))
    (do ((form (mread stream nil) (mread stream nil)) (forms nil (cons (third form) forms)))
        ((not (consp form)) (nreverse forms)))))

(defun evaluate-library-file (file)
  (let ((*package* (find-package :maxima)))
    (dolist (form (library-file-forms file))
      (if (lisp-file-p (library-file-path file))
          (eval (lisp-in-namespace form))
          (meval* (with-maximas-defaults (in-namespace form)))))))

;;; What a user sets changes how Maxima computes: obase : 8, modulus : 7, numer : true. Behind the
;;; library's own doors it computes as it does when it starts; but log(x^2), which has a value where x < 0, stays what
;;; it is, and does not become 2 log(x), which has none.
(defvar *defaults*
  '(($numer nil) ($float nil) ($keepfloat nil) ($%enumer nil) ($modulus nil) ($obase 10) ($ibase 10)
    ($algebraic nil) ($ratfac nil) ($domain $real) ($radexpand t) ($logexpand nil) ($listarith t)
    ($doallmxops t) ($domxmxops t) ($assumescalar t) ($exponentialize nil) ($demoivre nil) ($trigexpand nil)
    ($halfangles nil) ($stardisp nil) ($powerdisp nil) ($expop 0) ($expon 0)))

(defun with-maximas-defaults (statement)
  "A definition of a door with its body under the defaults; any other statement as it is."
  (if (and (eq (caar statement) 'mdefine) (door-p (caaadr statement)))
      (destructuring-bind (head function body) statement
        (list head function
              `((mprog) ((mlist) ,@(mapcar #'binding-of-flag *defaults*)) ((without-dependencies) ,body))))
      statement))

;;; depends(x, t), for diff(x, t) at the prompt: the library's dot(x) would be counted a second time.
(defmspec without-dependencies (form)
  (let ((depending (mapcar #'(lambda (item) (cons (caar item) (mget (caar item) 'depends))) (cdr $dependencies))))
    (unwind-protect (progn (dolist (each depending) (mremprop (car each) 'depends)) (meval (second form)))
      (dolist (each depending) (mputprop (car each) (cdr each) 'depends)))))

;;; Maxima's own reader takes some flags by another name: $modulus is modulus, $obase *print-base*.
(defun binding-of-flag (flag) (list '(msetq) (getalias (first flag)) (second flag)))

(defun door-p (name)
  (or (member name *steps* :key #'caar)
      (and (public-name-p name) (not (eq (gethash name *public-names*) 'entry))
           (not (member name '($dot $ddot $dddot $total $setting))))))

;;; ---- names that are made, and text that is read, while the library runs -----------------------

(defmacro define-library-version (name arguments &body body)
  "What the library's files mean when they call a function of Maxima's."
  `(progn (setf (gethash ',name *defined-names*) t)
          (setf (symbol-function (private-symbol ',name)) #'(lambda ,arguments ,@body))))

;;; A name made from a private one is what the library would read it as.
(define-library-version $concat (&rest parts)
  (let ((made (apply '$concat parts)))
    (if (and (symbolp made) (some #'private-symbol-p parts)) (read-name made) made)))

(define-library-version $parse_string (text) (in-namespace (parsed text)))
(define-library-version $eval_string (text) (meval (in-namespace (parsed text))))
(defun parsed (text) (mfuncall '$parse_string text)) ; which Maxima loads when it is first called

;;; ---- for Maxima --------------------------------------------------------------------------

(defmspec $public_names (form) (dolist (name (cdr form) '$done) (note name *public-names* 'function)))

(defmspec $public_steps (form)
  (dolist (call (cdr form) '$done) (note (caar call) *defined-names* t) (push call *steps*)))

(defmspec $private_names (form) (dolist (name (cdr form) '$done) (note name *defined-names* t)))

(defun public-option-p (value) (and (symbolp value) (eq (gethash value *public-names*) 'option)))

;;; The library stays out of Maxima's lists of what the user has made:  values,  functions,  and what
;;; kill(all)  kills.
(defun $load_library (directory files)
  (let ((again (equal directory (cdr (assoc (cdr files) *loaded-from* :test #'equal)))))
    (read-library (unless again (mapcar #'(lambda (file) (concatenate 'string directory file)) (cdr files))))
    (unless again (push (cons (cdr files) directory) *loaded-from*)))
  (setq *asked-for* t)
  '$done)

(defun read-library (paths)
  (let (($functions (copy-list $functions)) ($values (copy-list $values)) ($macros (copy-list $macros))
        ($arrays (copy-list $arrays)) ($props (copy-list $props)) ($structures (copy-list $structures))
        ($myoptions (copy-list $myoptions)))
    (mapc #'evaluate-library-file (mapcar #'read-library-file paths))
    (dolist (call *steps*) (unless (mget (caar call) 'mexpr) (define-step call)))) ; kill(name) may have taken it
  (setq $values (remove-if #'public-option-p $values)))

(defun define-step (call)
  "The plain name of a step:  name([given]) := called_step(internal, [a, b], [c], given)."
  (let* ((given (read-name '$given))
         (parameters (mapcar #'in-namespace (cdr call)))
         (optional (find-if #'$listp parameters)))
    (meval (with-maximas-defaults
             `((mdefine) ((,(caar call)) ((mlist) ,given))
               ((,(read-name '$called_step)) ((mquote) ,(read-function-name (caar call)))
                ((mquote) ((mlist) ,@(remove optional parameters))) ((mquote) ,(or optional '((mlist)))) ,given))))))

(defun $internal_names ()
  "The names private to the library, and that are none of Maxima's."
  (let ((names nil))
    (maphash #'(lambda (name read)
                 (unless (or (eq name read) (maximas-function-p name)) (push name names)))
             *read-names*)
    (cons '(mlist) (sort names #'alphalessp))))

(defun $open_namespace ()
  (setq *namespace-open* t)
  (setf (get '|$''| 'nud)
        #'(lambda (operator)
            (declare (ignore operator))
            (cons '$any (meval (in-namespace (parse '$any 190.))))))
  (let ((read-plainly (symbol-function 'mread)))
    (setf (symbol-function 'mread)
          #'(lambda (&rest arguments)
              (let ((statement (apply read-plainly arguments)))
                (if (and *namespace-open* (consp statement))
                    (list (first statement) (second statement) (in-namespace (third statement)))
                    statement))))
    '$done))

