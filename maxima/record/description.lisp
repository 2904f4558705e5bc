;;; The description, written as JSON and read again
;;;
;;; It holds more functions than other documents (mathjson.lisp): conditions, steps, extrema and tables,
;;;
;;;     ["Which", condition, value, ..., "True", value]     ["Max", a, b]     ["Table", k, "t"]: of "tables", from 0 on
;;;
;;; Nothing is evaluated while the document is read: an unknown function is an error.

(in-package :maxima)

(defvar *tables-described* nil "Tables of the description that is written or read.")
(defvar *joints-described* nil "Members of the description that is read: the name of a multiplier, that of its joint.")
(defvar *is-description* nil "Whether what is written is a description.")

(defvar *described-functions*
  '((mcond . "Which") ($max . "Max") (%max . "Max") ($min . "Min") (%min . "Min")
    ($unit_step . "UnitStep") (%unit_step . "UnitStep") ($hstep . "HalfStep") (%hstep . "HalfStep")
    (mgreaterp . "Greater") (mgeqp . "GreaterEqual") (mlessp . "Less") (mleqp . "LessEqual")
    (mand . "And") (mor . "Or") (mnot . "Not") ($equal . "Equal") ($notequal . "NotEqual")
    (mequal . "Same") (mnotequal . "NotSame"))
  "What a description may hold besides the functions of other documents and tables.")

;;; Written by the process that ran the scene file

(defun $write_described (tree file) (let ((*is-description* t)) ($write_json tree file)))
(defun $joints_described ()
  "name = multiplier for each joint of the description that was read."
  (mlist-of (mapcar #'(lambda (each) (list '(mequal simp) (described-symbol (cdr each)) (described-symbol (car each))))
                    *joints-described*)))

(defun $described_tables (tables) (setq *tables-described* (cdr tables)) tables)

(defvar *often-mistyped* '((mlist) $dot $ddot %sin %cos %tan $exp %log $sqrt mabs %signum)
  "Functions that an unknown one may be meant for.")

(defun $json_described (entry e)
  "An expression. One that no document can hold is an error where the entry is known."
  (let ((unknown (unknown-operator e)))
    (if unknown
        ($refuse '$function_not_described entry unknown (mfuncall '$did_you_mean unknown *often-mistyped*))
        (list '($json_expression) e))))

(defun $json_described_list (entry expressions)
  (cons '($json_array) (mapcar #'(lambda (e) ($json_described entry e)) (cdr expressions))))

(defun $json_described_values (entry items)
  (cons '($json_object)
        (mapcar #'(lambda (item) (mlist-of (list ($readable (second item)) ($json_described entry (third item)))))
                (cdr items))))

(defun unknown-operator (e)
  (cond ((or (atom e) (eq (caar e) 'bigfloat)) nil)
        ((eq (caar e) 'mrat) (unknown-operator ($totaldisrep e)))
        ((polygamma-p e) (unknown-operator (third e)))
        ((or (member 'array (car e)) (known-operator-p (caar e)))
         (dolist (part (cdr e)) (let ((unknown (unknown-operator part))) (when unknown (return unknown)))))
        ((eq (caar e) '$cubic_spline) nil)
        (t (caar e))))

(defun known-operator-p (symbol)
  (or (member symbol '(mplus mexpt rat))
      (assoc symbol *mathjson-functions*)
      (assoc symbol *described-functions*)))

(defun write-described (e out)
  "Write an expression that only a description may hold; nil for any other."
  (let ((head (and *is-description* (cdr (assoc (caar e) *described-functions*)))))
    (cond (head (write-tree head (cdr e) out) t)
          ((and *is-description* (eq (caar e) '$cubic_spline))
           (write-tree "Table" (list (position e *tables-described* :test #'alike1) (second e)) out)
           t))))

;;; Read by the process that derives

(defvar *written-otherwise*
  (list (cons "Power" #'power)
        (cons "Rational" #'div)
        (cons "Divide" #'div)
        (cons "Negate" #'neg)
        (cons "Subtract" #'sub)
        (cons "Sqrt" #'(lambda (x) (power x '((rat simp) 1 2))))
        (cons "Exp" #'(lambda (x) (power '$%e x)))
        (cons "PolyGamma" #'(lambda (n x) (simplifya (list '(mqapply) (list '($psi simp array) n) x) nil))))
  "How an application is made whose head is not that of one of Maxima's operators.")

(defvar *operators-of-heads* (make-hash-table :test 'equal))

(defun operator-of-head (head)
  "Of Maxima's operators that are written so the one that it simplifies; nil where there is none."
  (when (zerop (hash-table-count *operators-of-heads*))
    (dolist (pair (append *mathjson-functions* *described-functions*))
      (let ((known (gethash (cdr pair) *operators-of-heads*)))
        (unless (and known (get known 'operators))
          (setf (gethash (cdr pair) *operators-of-heads*) (car pair))))))
  (gethash head *operators-of-heads*))

(defun describe-anew (file)
  "Describe the system and the scenes of the description in FILE, under their names."
  (let* ((document (json-of-text (text-of-file file)))
         (*tables-described* (mapcar #'described-table (member-of document "tables")))
         (scenes (member-of document "scenes"))
         (system nil))
    (setq $closed_form_size (member-of document "closed_form_size")
          $settings (described-values (member-of document "settings"))
          $settings_used (mlist-of (mapcar #'second (cdr $settings)))
          *joints-described* (cdr (member-of document "joints")))
    (dolist (fact (member-of document "assumptions")) (mfuncall '$assume (described-expression fact)))
    (dolist (fact (member-of document "declarations"))
      (mapply1 '$declare (mapcar #'described-symbol fact) '$declare nil))
    (setq system (system-anew (member-of document "system")))
    (dolist (scene scenes)
      (bind-anew (member-of scene "name")
                 (mapply1 '$holonomic_scene (cons system (scene-entries scene)) '$holonomic_scene nil)))))

(defun system-anew (document)
  (let ((system (mapply1 '$holonomic_system (system-entries document) '$holonomic_system nil))
        (name (member-of document "name")))
    (unless (eq name 'null) (bind-anew name system))
    system))

(defun bind-anew (name structure)
  (let ((symbol (described-symbol name)))
    (when (boundp symbol) ($refuse '$taken_name symbol))
    (mset symbol structure)))

(defun system-entries (document)
  (entries-anew document
    '(($title . identity) ($source . identity) ($coordinates . described-names) ($controls . described-names)
      ($parameters . described-names) ($switches . described-names)
      ($kinetic_energy . described-effects) ($potential_energy . described-effects)
      ($forces . described-forces) ($constraints . described-list) ($orientations . described-list)
      ($drawing . described-drawing))))

(defun scene-entries (document)
  (observing (described-values (member-of document "outputs")) (entries-anew document
    '(($title . identity) ($effects . described-names) ($control_law . described-values)
      ($prescribed_reactions . described-values) ($servo_constraints . described-list)
      ($parameter_values . described-values) ($initial_state . described-values) ($initial_guess . described-values)
      ($nominal . described-values) ($time_span . described-list) ($until . described-list)
      ($released . described-releases) ($observe . described-names)))))

(defun observing (outputs entries)
  "The entries with outputs, name = expression, among what is observed."
  (mapcar #'(lambda (entry)
              (if (eq (second entry) '$observe)
                  (list (first entry) '$observe (mlist-of (append (cdr (third entry)) (cdr outputs))))
                  entry))
          entries))

(defun entries-anew (document readers)
  "entry = value for each member of DOCUMENT that is not null, read by the function that belongs to it."
  (mapcan #'(lambda (reader)
              (let ((value (member-of document (string-left-trim "$" (print-invert-case (car reader))))))
                (if (eq value 'null) nil (list (list '(mequal simp) (car reader) (funcall (cdr reader) value))))))
          readers))

(defun described-names (names) (mlist-of (mapcar #'described-symbol names)))
(defun described-list (trees) (mlist-of (mapcar #'described-expression trees)))

(defun described-values (members)
  (mlist-of (mapcar #'(lambda (each)
                      (list '(mequal simp) (described-symbol (car each)) (described-expression (cdr each))))
                  (cdr members))))

(defun described-releases (releases)
  (mlist-of (mapcar #'(lambda (each)
                      (list '(mequal simp)
                            (described-names (member-of each "multipliers"))
                            (described-expression (member-of each "condition"))))
                  releases)))

(defun described-effects (effects) (effects-anew effects #'described-expression))
(defun described-forces (effects) (effects-anew effects #'described-list))

(defun effects-anew (effects reader)
  (mlist-of (mapcar #'(lambda (each)
                      (list '(mequal simp)
                            (described-symbol (member-of each "effect"))
                            (funcall reader (member-of each "value"))))
                  effects)))

(defun described-drawing (shapes) (mlist-of (mapcar #'described-shape shapes)))

(defun described-shape (shape)
  "Places first, two numbers each, then the radius of a circle."
  (let* ((kind (described-symbol (member-of shape "shape")))
         (numbers (mapcar #'described-expression (member-of shape "numbers")))
         (parts nil))
    (do () ((null (cdr numbers))) (push (mlist-of (list (pop numbers) (pop numbers))) parts))
    (cons (list kind 'simp) (append (nreverse parts) numbers))))

(defun described-table (document)
  (list '($cubic_spline simp) nil
        (mlist-of (mapcar #'described-list (member-of document "points")))
        (let ((ends (member-of document "ends"))) (if (eq ends 'null) nil (described-list ends)))))

(defun described-expression (tree)
  (cond ((integerp tree) tree)
        ((stringp tree) (described-symbol tree))
        ((eq (car tree) 'members) (described-number (member-of tree "num")))
        (t (described-application (first tree) (rest tree)))))

(defvar *symbols-of-names* (make-hash-table :test 'equal))

(defun described-symbol (name)
  "As Maxima reads it: lambda and go are symbols of its own."
  (or (gethash name *symbols-of-names*)
      (setf (gethash name *symbols-of-names*) (symbol-of-name name))))

(defun symbol-of-name (name)
  (let ((constant (rassoc name *mathjson-constants* :test #'string=)))
    (if constant
        (car constant)
        (let ((symbol (intern-invert-case (concatenate 'string "$" name))))
          (or (get symbol 'alias) symbol)))))

(defun described-number (digits)
  "Return an integer, or the fraction with these decimal digits."
  (maxima-number
   (if (find-if #'(lambda (c) (find c ".eE")) digits) (decimal-fraction digits) (parse-integer digits))))

(defun described-application (head arguments)
  (cond ((string= head "Table")
         (destructuring-bind (number time) arguments
           (let ((table (nth number *tables-described*)))
             (list* (first table) (described-expression time) (cddr table)))))
        ((string= head "Subscript")
         (list* (list (described-symbol (first arguments)) 'simp 'array)
                (mapcar #'described-expression (rest arguments))))
        ((real-root-written-p head arguments)
         (apply #'power (mapcar #'described-expression (list (second (first arguments)) (third (second arguments))))))
        (t (applied-anew head (mapcar #'described-expression arguments)))))

(defun real-root-written-p (head arguments)
  "Whether a tree is x^(p/q), p and q odd, as mathjson.lisp writes it: Sign(x) times Power(Abs(x), p/q)."
  (and (string= head "Multiply")
       (equal (mapcar #'head-of arguments) '("Sign" "Power"))
       (equal (second (second arguments)) (cons "Abs" (rest (first arguments))))
       (equal (head-of (third (second arguments))) "Rational")
       (every #'oddp (rest (third (second arguments))))))

(defun head-of (tree) (if (consp tree) (first tree)))

(defun applied-anew (head arguments)
  (let ((made (cdr (assoc head *written-otherwise* :test #'string=))))
    (cond ((string= head "Add") (simplifya (cons '(mplus) (reverse arguments)) nil)) ; in no time if they descend
          (made (apply made arguments))
          ((operator-of-head head) (simplifya (cons (list (operator-of-head head)) arguments) nil))
          (t ($refuse '$head_not_described head)))))

;;; JSON: an object becomes (members (name . value) ...), an array the list of its items, null the symbol null. The text
;;; is a string, gone through by index: a stream takes three times as long.

(defvar *json-text* "" "What is read.")
(defvar *json-place* 0 "Where it is being read.")
(proclaim '(type simple-string *json-text*))
(proclaim '(type fixnum *json-place*))

(defun member-of (object name) (cdr (assoc name (cdr object) :test #'string=)))

(defun json-of-text (text)
  (let ((*json-text* text) (*json-place* 0)) (read-json)))

(defun next-of-json ()
  "The next character that is not white space, where the reading stays."
  (do ((c (schar *json-text* *json-place*) (schar *json-text* *json-place*)))
      ((not (or (char= c #\Space) (char= c #\Newline))) c)
    (incf *json-place*)))

(defun read-json ()
  (let ((c (next-of-json)))
    (cond ((char= c #\{) (incf *json-place*) (cons 'members (read-items #\} #'read-member)))
          ((char= c #\[) (incf *json-place*) (read-items #\] #'read-json))
          ((char= c #\") (read-json-string))
          ((or (digit-char-p c) (char= c #\-)) (read-json-integer))
          (t (incf *json-place* 4) 'null)))) ; the one word that a description has

(defun read-items (closing reader)
  (let ((items nil))
    (do ((c (next-of-json) (next-of-json)))
        ((char= c closing) (incf *json-place*) (nreverse items))
      (if (char= c #\,) (incf *json-place*) (push (funcall reader) items)))))

(defun read-member ()
  (let ((name (read-json)))
    (next-of-json)
    (incf *json-place*)
    (cons name (read-json))))

(defun read-json-string ()
  (let ((escaped nil) (start (1+ *json-place*)))
    (do ((c (schar *json-text* (incf *json-place*)) (schar *json-text* (incf *json-place*))))
        ((char= c #\"))
      (when (char= c #\\) (incf *json-place*) (setq escaped t)))
    (let ((found (subseq *json-text* start *json-place*)))
      (incf *json-place*)
      (if escaped (without-escapes found) found))))

(defun without-escapes (text)
  (with-output-to-string (out)
    (do ((i 0 (1+ i))) ((>= i (length text)))
      (if (char= (char text i) #\\) (incf i))
      (write-char (char text i) out))))

(defun read-json-integer ()
  (let* ((negative (char= (schar *json-text* *json-place*) #\-)) (number 0))
    (if negative (incf *json-place*))
    (do ((digit (digit-char-p (schar *json-text* *json-place*)) (digit-char-p (schar *json-text* *json-place*))))
        ((null digit) (if negative (- number) number))
      (setq number (+ (* 10 number) digit))
      (incf *json-place*))))
