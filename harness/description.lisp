;;; A description between two processes
;;;
;;; A scene file is a program, and may do anything to the Maxima that runs it. So one process runs the file and writes
;;; down what it described: the entries given to holonomic_system and holonomic_scene, what it assumed, and how long
;;; closed forms may be. A second one, which never sees the file, reads that as data, describes the same systems and
;;; scenes anew, and derives.
;;;
;;; A description is one expression, a list of: the settings used; closed_form_size; what is assumed; the systems; their
;;; names, each with the number of its system; the scenes, each with its name and the number of its system. It is
;;; written thus, a blank after each item:
;;;
;;;   i123      an integer                          s3:abc   a string, its length before it
;;;   f3/4      a float, as a quotient              y2:$x    a symbol, the length of its name before it
;;;   b53:7:-2  a bigfloat of 53 bits, 7 and -2     ( y5:MPLUS ... )   an operator with its arguments
;;;   r2        the second table once more          [ y2:$x ... ]      a name with its indices
;;;
;;; Nothing is evaluated while it is read. An operator that is not known, or a symbol that is no name in Maxima's
;;; language, is refused. Files of many bodies are long: they are read from memory, and without `loop', which an
;;; interpreter is slow at.

(in-package :maxima)

(defvar *tables-met* nil "The tables that a description holds, as far as it is written or read, the latest first.")

(defvar *described-operators*
  '(mplus mtimes mexpt mlist mequal rat $matrix
    mcond mgreaterp mgeqp mlessp mleqp mand mor mnot mnotequal $equal $kind
    $max %max $min %min $unit_step %unit_step $hstep %hstep
    $cubic_spline $table_value $point $segment $polyline $circle $mechanical_system $motion_scene $servo_motion)
  "What a description may hold besides the functions that documents know.")

;;; The first fields of the structures in system.mac and scene.mac

(defun entries-of (structure) (cdr (second structure)))
(defun system-of (scene) (third scene))

(defun without-systems (scene)
  "SCENE as it would be if it held no systems, which are described by themselves, and no splines of its tables."
  (list* (first scene) (second scene) nil nil nil (nthcdr 5 scene)))

;;; Written by the process that ran the scene file

(defun write-description (file)
  "Write what the scene file described to FILE; nothing where it did not load the library."
  (when (and (boundp '*asked-for*) (symbol-value '*asked-for*))
    (let ((*print-base* 10) (*print-radix* nil) (*tables-met* nil)) ; obase : 8 of a scene is none of a description's
      (write-file file (with-output-to-string (out) (write-datum (description) out))))))

(defun description ()
  (let* ((named (structures-of-kind '$mechanical_system))
         (scenes (structures-of-kind '$motion_scene))
         (systems (remove-duplicates (append (mapcar #'cdr named) (mapcar (lambda (item) (system-of (cdr item))) scenes))
                                     :test #'alike1 :from-end t)))
    (mapc #'require-known-functions (append systems (mapcar #'cdr scenes)))
    (flet ((number-of (system) (position system systems :test #'alike1)))
      (listed (listed* (cdr $settings_used))
              (required-size $closed_form_size)
              (mfuncall '$facts)
              (listed* systems)
              (listed* (loop for (name . system) in named collect (listed name (number-of system))))
              (listed* (loop for (name . scene) in scenes
                             collect (listed name (number-of (system-of scene)) (without-systems scene))))))))

(defun required-size (size)
  (if (and (integerp size) (plusp size))
      size
      (merror "closed_form_size must be a positive integer; it is ~M" size)))

(defun require-known-functions (structure)
  "Refuse what no document can hold where the entry that holds it is known."
  (dolist (entry (entries-of structure))
    (let ((unknown (unknown-operator (third entry))))
      (when unknown
        (merror "~M contains the function ~M, which no program or document can hold; write it with elementary functions, or, where it is of the time alone, as a control with a table of its values"
                (second entry) unknown)))))

(defun unknown-operator (e)
  (cond ((or (atom e) (eq (caar e) 'bigfloat)) nil)
        ((eq (caar e) 'mrat) (unknown-operator ($totaldisrep e)))
        ((or (member 'array (car e)) (known-operator-p (caar e)))
         (dolist (part (cdr e)) (let ((unknown (unknown-operator part))) (when unknown (return unknown)))))
        (t (caar e))))

(defun listed (&rest items) (listed* items))
(defun listed* (items) (cons '(mlist simp) items))

(defun structures-of-kind (kind)
  "(name . structure) for each name with a value of that kind, oldest first."
  (loop for name in (cdr $values)
        for value = (and (boundp name) (symbol-value name))
        when (and (consp value) (consp (car value)) (eq (caar value) kind)) collect (cons name value)))

(defun write-datum (e out)
  (cond ((integerp e) (write-char #\i out) (princ e out) (write-char #\Space out))
        ((stringp e) (format out "s~D:~A " (length e) e))
        ((floatp e) (format out "f~D/~D " (numerator (rational e)) (denominator (rational e))))
        ((symbolp e) (write-symbol e out))
        ((atom e) (merror "a description cannot hold ~M" e))
        ((eq (caar e) 'bigfloat) (format out "b~D:~D:~D " (car (last (car e))) (second e) (third e)))
        ((member 'array (car e)) (write-application #\[ e #\] out))
        ((eq (caar e) 'mrat) (write-datum ($totaldisrep e) out))
        ((member e *tables-met* :test #'eq)
         (format out "r~D " (length (member e *tables-met* :test #'eq))))
        (t (if (eq (caar e) '$cubic_spline) (push e *tables-met*))
           (write-application #\( e #\) out))))

(defun write-symbol (symbol out)
  (write-char #\y out)
  (princ (length (symbol-name symbol)) out)
  (write-char #\: out)
  (write-string (symbol-name symbol) out)
  (write-char #\Space out))

(defun write-application (opening e closing out)
  (write-char opening out)
  (write-symbol (caar e) out)
  (dolist (argument (cdr e)) (write-datum argument out))
  (write-char closing out))

;;; Read by the process that derives

(defun describe-anew (file)
  "Describe the systems and scenes in FILE, under their names."
  (destructuring-bind (used size facts systems names scenes) (cdr (described-in (text-of-file file)))
    (setq $settings_used used)
    (setq $closed_form_size (required-size size))
    (mapc #'assume-anew (cdr facts))
    (let ((systems (mapcar (lambda (system) (described-anew '$holonomic_system (entries-of system) system))
                           (cdr systems))))
      (loop for (nil name number) in (cdr names) do (bind-anew name (nth number systems)))
      (loop for (nil name number scene) in (cdr scenes)
            do (bind-anew name (described-anew '$holonomic_scene (cons (nth number systems) (entries-of scene)) scene))))))

(defun described-in (text)
  (let ((*tables-met* nil))
    (with-input-from-string (in text) (read-datum in))))

(defun described-anew (describe entries expected)
  "What DESCRIBE makes of ENTRIES, which must be what it made of them before."
  (let ((made (mapply1 describe entries describe nil)))
    (unless (alike1 (if (eq describe '$holonomic_scene) (without-systems made) made) expected)
      (merror "what ~M returned was changed afterwards, or the file sets an option of Maxima's that changes it; ~
               leave that out, or run the file with --trust" describe))
    made))

(defun bind-anew (name structure)
  (when (boundp name)
    (merror "the name ~M is taken by Maxima or by the library; choose another" name))
  (mset name structure))

(defun assume-anew (fact)
  (if (eq (caar fact) '$kind)
      (mfuncall '$declare (second fact) (third fact))
      (mfuncall '$assume fact)))

(defun read-datum (in)
  (ecase (peek-char t in)
    (#\( (read-char in) (known-application (read-until #\) in)))
    (#\[ (read-char in) (indexed-name (read-until #\] in)))
    (#\i (read-char in) (read-whole in))
    (#\s (read-char in) (read-text in))
    (#\y (read-char in) (described-symbol (read-text in)))
    (#\r (read-char in) (table-met (read-whole in)))
    (#\f (read-char in) (float (/ (read-whole in) (read-whole in)) 1d0))
    (#\b (read-char in) (let ((bits (read-whole in)))
                          (list (list 'bigfloat 'simp bits) (read-whole in) (read-whole in))))))

(defun table-met (number)
  (if (<= 1 number (length *tables-met*))
      (nth (- (length *tables-met*) number) *tables-met*)
      (merror "the description has no table ~M so far" number)))

(defun read-until (closing in)
  (let ((items nil))
    (do () ((eql (peek-char t in) closing) (read-char in) (nreverse items))
      (push (read-datum in) items))))

(defun read-whole (in)
  "An integer and the one character after it."
  (let ((digits nil))
    (do ((c (read-char in) (read-char in)))
        ((not (or (digit-char-p c) (char= c #\-))) (parse-integer (coerce (nreverse digits) 'string)))
      (push c digits))))

(defun read-text (in)
  (let ((text (make-string (read-whole in))))
    (read-sequence text in)
    text))

(defun described-symbol (name)
  "Names of Maxima's language begin with $ or %, but for true, false, the operators, and those that Maxima reads as
symbols of its own: lambda, go, return."
  (let ((symbol (find-symbol name :maxima)))
    (cond ((and (plusp (length name)) (find (char name 0) "$%")) (intern name :maxima))
          ((or (member symbol '(t nil)) (known-operator-p symbol) (get symbol 'reversealias)) symbol)
          (t (merror "the scene describes its system with ~M, which no document can hold" name)))))

(defun known-operator-p (symbol)
  (or (member symbol *described-operators*) (assoc symbol *mathjson-functions*)))

(defun known-application (items)
  (destructuring-bind (operator &rest arguments) items
    (unless (known-operator-p operator)
      (merror "the scene describes its system with ~M, which no document can hold" operator))
    (cond ((member operator '($mechanical_system $motion_scene $servo_motion))
           (cons (list operator 'simp) arguments))
          ((eq operator '$cubic_spline) (car (push (cons (list operator 'simp) arguments) *tables-met*)))
          (t (simplifya (cons (list operator) (if (eq operator 'mplus) (reverse arguments) arguments)) nil)))))

(defun indexed-name (items)
  (cons (list (first items) 'simp 'array) (rest items)))
