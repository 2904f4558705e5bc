;;; Headless Maxima: one file, one call, no prompts, one outcome
;;;
;;; Maxima in batch mode leaves with status 0 in every case, continues after a Lisp error and repeats a
;;; question for ever without an answer. A job loads this file first and then calls one of
;;;
;;;   RUN-FILE         reads a file statement by statement, as batchload does, remembering where each one starts, and
;;;                    evaluates a closing call, for example write_record("record.json");
;;;   RUN-SCENE        reads the file likewise and writes down what it described, if it loaded the library;
;;;   RUN-DESCRIPTION  reads no file but such a description, and evaluates calls, each of which has its own outcome.
;;;
;;; Each makes an error of all that would stop or prompt, a question, a syntax error, a Lisp error, and leaves the
;;; outcome in a file: a mark that the run is given, the kind of ending, the file, the line of the statement (0
;;; outside of them), the id of the library's refusal (empty if it is none), the message, of a refusal as JSON with its
;;; parts, and the mark again, a line each. Until the end the kind is STARTED.
;;;
;;; The kinds of endings are FINISHED, FAULT (Maxima or the file itself refused), QUESTION, SYNTAX and LISP.

(in-package :maxima)

(define-condition unanswered-question (error)
  ((text :initarg :text :reader text)))

(define-condition unreadable-statement (error)
  ((text :initarg :text :reader text)))

(defvar *statement-stream* nil "The file being run, open; while a loaded file fails to parse, that one.")
(defvar *statement-start* nil "Its position at the start of the statement being run; NIL outside of them.")

;;; What would stop or prompt

(defun retrieve (message flag)
  "Maxima's only function for questions; a batch run cannot answer."
  (declare (ignore flag))
  (error 'unanswered-question :text (plain-text message)))

;; read() and readonly() ask without it.
(defun $readonly (&rest prompt)
  (error 'unanswered-question :text (format nil "~{~A~^ ~}" (mapcar #'plain-text prompt))))

;; So do these, which open a prompt; in some versions of Maxima they are given their arguments as they stand.
(dolist (door '($break $to_lisp))
  (let ((call (list (list door))))
    (flet ((refuse (&rest arguments)
             (declare (ignore arguments))
             (error 'unanswered-question :text (plain-text call))))
      (setf (symbol-function door) #'refuse)
      (when (get door 'mfexpr*) (setf (get door 'mfexpr*) #'refuse)))))

(defun mread-synerr (control &rest arguments)
  "Maxima's one door for syntax errors: the place is that of the file being parsed, perhaps a loaded one."
  (when (typep *parse-stream* 'file-stream)
    (setq *statement-stream* *parse-stream*
          *statement-start* (file-position *parse-stream*)))
  (flet ((spelt (item) (if (stringp item) (maybe-invert-string-case item) item)))
    (error 'unreadable-statement :text (apply #'format nil control (mapcar #'spelt arguments)))))

;; A scene that was copied out of the library's folder, or is read by another installation, means this library. Where it
;; is loaded, as in an image, its list of files is not read again.
(let ((load-file (symbol-function '$load)))
  (defun $load (file)
    (let ((file (if (library-not-there-p file) "holonom.mac" file)))
      (if (loaded-library-p file)
          (setf (symbol-value '*asked-for*) t)
          (funcall load-file file)))))

(defun loaded-library-p (file)
  (let ((loaded (and (boundp '*loaded-from*) (cdar (symbol-value '*loaded-from*)))))
    (and loaded
         (stringp file)
         (or (equal file "holonom.mac")
             (and (probe-file file)
                  (equal (namestring (truename file)) (concatenate 'string loaded "holonom.mac")))))))

(defun library-not-there-p (file)
  (and (stringp file)
       (let ((start (search "/maxima/holonom.mac" file :from-end t)))
         (and start (= (+ start (length "/maxima/holonom.mac")) (length file))))
       (not (probe-file file))))

;;; The run

(defun run-file (copy call job)
  "Run COPY, the text of the file, then the Maxima text CALL."
  (with-open-file (*statement-stream* copy)
    (run-job job (lambda ()
                   (run-statements (first job))
                   (evaluate-text call)))))

(defun run-scene (copy description job)
  "Run COPY, the text of the scene file, and write what it described to DESCRIPTION."
  (with-open-file (*statement-stream* copy)
    (run-job job (lambda ()
                   (run-statements (first job))
                   (when (and (boundp '*asked-for*) (symbol-value '*asked-for*))
                     (mfuncall '$write_description description))))))

(defun run-description (description calls job)
  "Describe anew what DESCRIPTION holds, then run CALLS, each a Maxima text and the file of its outcome."
  (destructuring-bind (name mark) (list (first job) (fifth job))
    (run-job job (lambda ()
                   (mfuncall '$load "holonom.mac")
                   (describe-anew description)
                   (loop for (call outcome) in calls
                         do (write-outcome outcome mark name '(started ""))
                            (write-outcome outcome mark name (ending-of (lambda () (evaluate-text call)))))))))

(defun run-job (job run)
  "Do what JOB prepares, then RUN. A job is (name of the file run, where load() looks first, Maxima text that comes
before all, outcome, mark)."
  (destructuring-bind (name library preparation outcome mark) job
    (write-outcome outcome mark name '(started ""))
    (setq $file_search_maxima
          `((mlist) ,(format nil "~A/$$$.mac" library) ,@(cdr $file_search_maxima)))
    (let ((ending (ending-of (lambda ()
                               (setq $logexpand nil) ; log(x^2) has a value where x < 0, and 2 log(x) has none
                               (evaluate-text preparation)
                               (funcall run)))))
      (write-outcome outcome mark name ending)
      (leave (if (eq (first ending) 'finished) 0 1)))))

(defun run-statements (file)
  (let (($load_pathname file) (*mread-prompt* ""))
    (loop
      (skip-blanks *statement-stream*)
      (setq *statement-start* (file-position *statement-stream*))
      (let ((statement (read-statement)))
        (unless (consp statement) (return))
        (refuse-taken-names (third statement))
        (meval* (third statement)))))
  (setq *statement-start* nil))

(defun refuse-taken-names (form)
  "Refuse to define a function of Maxima's or the library's anew: what calls it would go wrong elsewhere."
  (unless (or (atom form) (atom (car form)))
    (when (member (caar form) '(mdefine mdefmacro $define))
      (let ((name (and (consp (second form)) (consp (car (second form))) (caar (second form)))))
        (when (taken-name-p name)
          (merror "~M is a function of ~A: give yours another name." name
                  (if (public-function-p name) "Holonom's" "Maxima's")))))
    (mapc #'refuse-taken-names (cdr form))))

(defun taken-name-p (name)
  (and (symbolp name)
       (or (fboundp name) (get name 'mfexpr*) (public-function-p name))
       (not (member name (cdr $functions) :key #'caar))))

(defun public-function-p (name)
  "Whether a scene may call it; total(f) stands in results alone."
  (and (not (eq name '$total))
       (boundp '*public-names*)
       (eq (gethash name (symbol-value '*public-names*)) 'function)
       (mget name 'mexpr)))

(defun read-statement ()
  (handler-case (mread *statement-stream* nil)
    (unreadable-statement (condition) (error condition))
    (error (condition) (error 'unreadable-statement :text (lisp-message condition)))))

(defun evaluate-text (text)
  (let ((*mread-prompt* ""))
    (with-input-from-string (stream text)
      (meval* (third (mread stream))))))

(defun ending-of (run)
  "Call RUN; return the kind of its ending and, for a failure, the message."
  (let ((errcatch (cons bindlist loclist)) (*mdebug* nil) ($errormsg nil))
    (declare (special errcatch))
    (catch 'macsyma-quit
      (return-from ending-of
        (handler-case (progn (rat-error-to-merror (funcall run)) '(finished ""))
          (maxima-$error () (unbound errcatch (fault)))
          (unanswered-question (condition) (unbound errcatch (list 'question (text condition))))
          (unreadable-statement (condition) (unbound errcatch (list 'syntax (text condition))))
          (serious-condition (condition) (unbound errcatch (list 'lisp (lisp-message condition)))))))
    '(fault "Maxima went back to its prompt")))

(defun unbound (outside ending)
  "ENDING, after the variables of the blocks that it broke off have got back their values of OUTSIDE."
  (errlfun1 outside)
  ending)

(defun fault ()
  "Return Maxima's error: its message, or for a refusal of the library its message with its parts as JSON, and its id."
  (let ((met (and (boundp '*asked-for*)
                  (symbol-value '*asked-for*)
                  (mfuncall (funcall 'read-name '$refusal_met)))))
    (if met
        (list 'fault
              (with-output-to-string (out)
                (funcall 'write-json (mfuncall (funcall 'read-name '$json_reason) (fifth met)) out))
              (funcall 'characters-of-name (second met)))
        (list 'fault (maxima-message)))))

;;; Text for people: one line, names without the backslashes that Maxima's own reader wants

(defun maxima-message ()
  "The text of Maxima's variable error, expressions written out in full."
  (let (($errormsg t)
        (linel most-positive-fixnum)
        ($linel most-positive-fixnum)     ; which newer versions go by where a message holds an expression
        ($error `((mlist) ,@(mapcar (lambda (item) (if (consp item) (plain-text item) item)) (cdr $error)))))
    (one-line (with-output-to-string (*standard-output*) ($errormsg)))))

(defun lisp-message (condition)
  "Return the message of a Lisp condition, without GCL's name of the function; for a wrong type, the value itself."
  (let ((said (one-line (if (typep condition 'simple-condition)
                            (apply #'format nil (simple-condition-format-control condition)
                                   (simple-condition-format-arguments condition))
                            (princ-to-string condition)))))
    (if (and (string= said "") (typep condition 'type-error))
        (format nil "~A is not of type ~(~A~)" (as-text (type-error-datum condition)) (type-error-expected-type condition))
        said)))

(defun as-text (datum)
  (handler-case (plain-text datum)
    (error () (one-line (princ-to-string datum)))))

(defun plain-text (message)
  "A question of Maxima's, a string or (mtext) with strings and expressions, as one line."
  (if (and (consp message) (eq (caar message) 'mtext))
      (format nil "~{~A~}" (mapcar #'plain-text (cdr message)))
      (one-line (if (stringp message) message (coerce (mstring message) 'string)))))

(defun one-line (text)
  (substitute #\Space #\Newline (remove #\\ text)))

;;; Places in a file

(defun skip-blanks (stream)
  "Move STREAM past white space and comments, which Maxima nests."
  (loop for next = (peek-char t stream nil)
        while (and (eql next #\/) (comment-starts-p stream))
        do (skip-comment stream)))

(defun comment-starts-p (stream)
  (let ((position (file-position stream)))
    (or (and (read-char stream) (eql (read-char stream nil) #\*))
        (progn (file-position stream position) nil))))

(defun skip-comment (stream)
  "Move STREAM, just past an opening mark, past the closing one."
  (loop with depth = 1 and previous = nil
        for next = (read-char stream nil)
        while next
        do (cond ((and (eql previous #\*) (eql next #\/)) (decf depth) (setq next nil))
                 ((and (eql previous #\/) (eql next #\*)) (incf depth) (setq next nil)))
           (setq previous next)
        until (zerop depth)))

(defun line-at (position file)
  "The number of the line that holds POSITION in FILE, from 1."
  (with-open-file (stream file)
    (1+ (loop until (>= (file-position stream) position) count (eql (read-char stream nil) #\Newline)))))

;;; The ending

(defun write-outcome (outcome mark name ending)
  (destructuring-bind (kind message &optional (refusal "")) ending
    (let* ((file (if *statement-start* (namestring (truename *statement-stream*)) name))
           (line (if *statement-start* (line-at *statement-start* file) 0)))
      (with-open-file (stream outcome :direction :output :if-exists :supersede)
        (format stream "~A~%~A~%~A~%~D~%~A~%~A~%~A~%"
                mark kind (substitute #\Space #\Newline file) line refusal message mark)))))

(defun leave (status)
  (finish-output)
  #+gcl (si::bye status)
  #+sbcl (sb-ext:exit :code status :abort t)
  #+ecl (si:quit status)
  #+ccl (ccl:quit status))
