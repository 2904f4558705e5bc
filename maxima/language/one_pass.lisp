;;; Long expressions in one pass
;;;
;;; The kinetic energy of many bodies is a long sum: it is gone through once for all names. Maxima's sum compares each
;;; new term with those it has, from the greatest on; terms that come in descending order find their place at once.
;;;
;;; GCL's some, every, find-if, position, count-if and reduce look each item of a list up from its beginning: what goes
;;; through lists of any length asks these.

(in-package :maxima)

(defun any-of-p (test items) (dolist (item items) (if (funcall test item) (return t))))
(defun all-of-p (test items) (dolist (item items t) (if (not (funcall test item)) (return nil))))

(defun more-than-one-p (test items)
  (let ((met nil))
    (dolist (item items) (if (funcall test item) (if met (return t) (setq met t))))))

(defun sum-of-all (numbers) (let ((sum 0)) (dolist (number numbers sum) (incf sum number))))

(defun largest-of (numbers)
  (let ((largest (car numbers))) (dolist (number (cdr numbers) largest) (setq largest (max largest number)))))

(defun same-items-p (items others)
  "Whether two lists of one length hold the very same items."
  (do ((items items (cdr items)) (others others (cdr others)))
      ((not (and items (eq (car items) (car others)))) (null items))))

(defun $names_in (e)
  "The variables of an expression, as listofvars finds them, in the order in which they are met."
  (let ((known (make-known-names)) (waiting (list e)))
    (do () ((null waiting) (mlist-of (nreverse (known-names-found known))))
      (let ((part (pop waiting)))
        (cond ((or (numberp part) (member part '(t nil))))
              ((or (symbolp part) (and (consp part) (member 'array (car part))))
               (if (not (or (met-before-p part known) ($constantp part))) (note-name part known)))
              ((atom part))
              ((specrepp part) (push (specdisrep part) waiting))
              (t (setq waiting (append (cdr part) waiting))))))))

;;; A table of few names takes longer to make than to do without.

(defstruct known-names found table (count 0))
(defvar *few-names* 16)

(defun met-before-p (name known)
  (if (and (known-names-table known) (symbolp name))
      (gethash name (known-names-table known))
      (member name (known-names-found known) :test #'equal)))

(defun note-name (name known)
  (push name (known-names-found known))
  (cond ((known-names-table known) (setf (gethash name (known-names-table known)) t))
        ((> (incf (known-names-count known)) *few-names*)
         (let ((table (setf (known-names-table known) (make-hash-table))))
           (dolist (each (known-names-found known)) (setf (gethash each table) t))))))

(defun $applications_of (operator e)
  "The different parts of an expression that apply the operator, in the order in which they are met."
  (applications-of-any (list operator) e))

(defun applications-of-any (operators e)
  (let ((found nil) (waiting (list e)))
    (do () ((null waiting) (cons '(mlist simp) (nreverse found)))
      (let ((part (pop waiting)))
        (cond ((atom part))
              ((specrepp part) (push (specdisrep part) waiting))
              ((member (caar part) operators) (if (not (member part found :test #'alike1)) (push part found)))
              (t (setq waiting (append (cdr part) waiting))))))))

(defun $different_roots (e)
  "The different powers b^(p/q) in an expression, b^(-p/q) as these, sums in the order in which they are displayed."
  (mlist-of (remove-duplicates (roots-in e) :test #'alike1 :from-end t)))

(defun roots-in (e)
  (cond ((or (atom e) (member 'array (car e))) nil)
        ((specrepp e) (roots-in (specdisrep e)))
        (t (append (if (and (eq (caar e) 'mexpt) ($ratnump (third e)) (not (integerp (third e))))
                       (list (power (second e) (take '(mabs) (third e)))))
                   (mapcan #'roots-in (if (eq (caar e) 'mplus) (reverse (cdr e)) (cdr e)))))))

(defun $name_around (before name after)
  "The name with a prefix and a suffix; concat would take  set,  an operator, by its sign {."
  (intern-invert-case (concatenate 'string "$" before (characters-of-name name) after)))

(defun $dotted (dots x)
  "dot(x), ddot(x), dddot(x): of a name another name, which is made once; of a list the list of them."
  (cond ((symbolp x)
         (or (get x dots)
             (setf (get x dots) ($name_around (concatenate 'string (characters-of-name dots) "(") x ")"))))
        (($listp x) (mlist-of (mapcar #'(lambda (each) ($dotted dots each)) (cdr x))))
        (($subvarp x) (list (list dots 'simp) x)) ; as it is written, in index notation
        (t ($refuse '$dot_of_expression (characters-of-name dots) x))))

(defun $initial (x)
  "x_0, a name that is made once."
  (or (get x 'initial) (setf (get x 'initial) ($name_around "" x "_0"))))

(defun $with_initial_names (items)
  "x_0 = value for each  x = value."
  (mlist-of (mapcar #'(lambda (item) (list '(mequal simp) ($initial (second item)) (third item))) (cdr items))))

;;; Tables, by which a name or number is found at once however many there are: of  name = value, and of names.

(defun table-for (keys)
  "An empty table. GCL takes ten times as long to compare as lists and texts are compared."
  (make-hash-table :test (if (all-of-p #'(lambda (key) (or (symbolp key) (integerp key))) keys) 'eql 'equal)))

(defun $new_table () (table-of nil nil))

(defun $table_of_values (items) (table-of (mapcar #'second (cdr items)) (mapcar #'third (cdr items))))
(defun $table_of_names (names) (table-of (cdr names) (mapcar #'(lambda (name) (declare (ignore name)) t) (cdr names))))

(defun table-of (names values)
  "As make_array(hashed, 1) makes it."
  (let ((table (table-for names)))
    (setf (gethash 'dim1 table) t)
    (mapc #'(lambda (name value) (setf (gethash name table) value)) names values)
    table))

(defun $kinds_of_names (moving constant)
  "A table of the names, moving or constant; the time is constant."
  (let ((constant (cons '$t (cdr constant))))
    (table-of (append constant (cdr moving))
              (nconc (make-list (length constant) :initial-element '$constant)
                     (make-list (length (cdr moving)) :initial-element '$moving)))))

(defun $values_in (table names) (mlist-of (mapcar #'(lambda (name) (gethash name table)) (cdr names))))
(defun $names_inside (table names) (mlist-of (remove-if-not #'(lambda (name) (gethash name table)) (cdr names))))
(defun $names_outside (table names) (mlist-of (remove-if #'(lambda (name) (gethash name table)) (cdr names))))

(defun $without_repeats (items)
  (let ((met (table-for (cdr items))) (others nil) (distinct nil))
    (dolist (x (cdr items) (mlist-of (nreverse distinct)))
      (cond ((atom x) (unless (gethash x met) (setf (gethash x met) t) (push x distinct)))
            ((not (member x others :test #'alike1)) (push x others) (push x distinct))))))

(defun $items_inside (table items)
  "Of  name = value  those whose name the table has."
  (mlist-of (remove-if-not #'(lambda (item) (gethash (second item) table)) (cdr items))))

(defun $assoc_pair (name pairs)
  "The value of the first [name, value] of that name."
  (third (car (member-if #'(lambda (pair) (alike1 (second pair) name)) (cdr pairs)))))

(defun $items_failing (test items) (mlist-of (remove-if #'(lambda (item) (mfuncall test item)) (cdr items))))

(defun $repeated_items (items)
  "The items of a list that stand in it before."
  (let ((met (table-for (cdr items))))
    (mlist-of (remove-if-not #'(lambda (x) (or (gethash x met) (progn (setf (gethash x met) t) nil))) (cdr items)))))

(defun $equationp (e) (and (consp e) (eq (caar e) 'mequal)))

(defun $values_to_verify (table items)
  "The items that are not  name = rational number  with a name that the table has."
  (mlist-of (remove-if #'(lambda (item) (and ($equationp item) (gethash (second item) table) ($ratnump (third item))))
                       (cdr items))))

(defun $shape_drawn (item)
  "The kind of a shape in a drawing, the coordinates of its places, its radius; false for what is none."
  (let ((places (shape-places item)))
    (and places
         (mlist-of (cons (characters-of-name (caar item))
                         (append (mapcan #'(lambda (place) (copy-list (cdr place))) places)
                                 (nthcdr (length places) (cdr item))))))))

(defun shape-places (item)
  (let* ((kind (and (consp item) (caar item))) (count (and (consp item) (length (cdr item))))
         (places (case kind
                   ($point (if (= count 1) (cdr item)))
                   ($segment (if (= count 2) (cdr item)))
                   ($polyline (if (> count 1) (cdr item)))
                   ($circle (if (and (= count 2) (not ($listp (third item)))) (list (second item)))))))
    (and (all-of-p #'place-p places) places)))

(defun place-p (x) (and ($listp x) (= (length x) 3) (not (any-of-p #'$listp (cdr x)))))

(defun $contains_floats (e) (some-part-p #'(lambda (part) (or (floatp part) (bigfloatp part))) e))

(defun $contains_strings (e) (some-part-p #'stringp e))

(defun $contains_root (e)
  "Whether a power in it has a fraction for its exponent."
  (some-part-p #'(lambda (part) (and (consp part) (eq (caar part) 'mexpt) (ratnump (third part)))) e))

(defun some-part-p (test e)
  (cond ((funcall test e) t)
        ((or (atom e) (member 'array (car e))) nil)
        ((specrepp e) (some-part-p test (specdisrep e)))
        (t (any-of-p #'(lambda (part) (some-part-p test part)) (cdr e)))))

(defun $expression_size (e)
  "Number of symbols, numbers and operations, as they are displayed."
  (let ((size 1))
    (if (not ($mapatom e)) (dolist (part (cdr (format1 e))) (incf size ($expression_size part))))
    size))

(defun $substituted (values e)
  "The expression with  name = value  put in for its symbols, all at once."
  (let ((table (make-hash-table :size 16)))
    (dolist (item (cdr values)) (setf (gethash (second item) table) (third item)))
    (if (cdr values) (put-in table e) e)))

(defun put-in (table e)
  (cond ((symbolp e) (gethash e table e))
        ((atom e) e)
        ((specrepp e) (put-in table (specdisrep e)))
        (t (let ((parts (mapcar #'(lambda (part) (put-in table part)) (cdr e))))
             (cond ((same-items-p parts (cdr e)) e)
                   ((eq (caar e) 'mplus) (sum-of-many parts))
                   (t (simplifya (cons (remove 'simp (car e)) parts) t)))))))

(defun $sum_in_order (terms)
  (if (any-of-p #'specrepp (cdr terms)) (simplifya (cons '(mplus) (cdr terms)) t) (sum-of-many (cdr terms))))

(defun sum-of-many (terms) (simplifya (cons '(mplus) (greatest-to-least terms)) t))

(defun greatest-to-least (terms)
  "Terms of a sum of Maxima's come from the least to the greatest, and with values put in they mostly stay so."
  (let ((backwards (reverse terms)))
    (if (descending-p backwards) backwards (sort backwards #'great))))

(defun descending-p (terms)
  (do ((terms terms (cdr terms))) ((null (cdr terms)) t)
    (if (not (great (first terms) (second terms))) (return nil))))

;;; ---- of many, most are zero --------------------------------------------------------------
;;;
;;; The derivative of one coordinate by another is nearly always zero. Derivatives are taken by the names that a
;;; term contains, and products and images are formed of what is not zero.

(defun $gradient (e names)
  "Partial derivatives by the names, a list."
  (let ((terms (terms-by-name e)))
    (mlist-of (mapcar #'(lambda (name)
                          (cond ((not (symbolp name)) (diff-between-jumps (list e name)))
                                ((gethash name terms)
                                 (diff-between-jumps (list (sum-of-many (gethash name terms)) name)))
                                (t 0)))
                      (cdr names)))))

(defun terms-by-name (e)
  "The terms of the sum that contain each name."
  (let ((table (make-hash-table :size 16)) (e (if (specrepp e) (specdisrep e) e)))
    (dolist (term (if (and (consp e) (eq (caar e) 'mplus)) (cdr e) (list e)) table)
      (dolist (name (cdr ($names_in term))) (push term (gethash name table))))))

(defun $inner (a b)
  "The sum of the products of two lists."
  (let ((products nil))
    (mapc #'(lambda (x y) (or (eql x 0) (eql y 0) (push (mul x y) products))) (cdr a) (cdr b))
    (sum-of-many products)))

(defun $over_nonzero (f items)
  "What  f  makes of the items, of a list or of a matrix; it is taken to make zero of zero."
  (cons (car items)
        (mapcar #'(lambda (item)
                    (cond ((eql item 0) 0)
                          (($listp item) ($over_nonzero f item))
                          (t (mapply1 f (list item) f nil))))
                (cdr items))))

(defun $nonzero_places (items)
  "The places of a list at which it is not zero."
  (let ((place 0) (places nil))
    (dolist (item (cdr items) (mlist-of (nreverse places)))
      (incf place)
      (or (eql item 0) (push place places)))))

(defun $items_at (places items)
  "The items of a list at these places."
  (let ((items (coerce (cdr items) 'vector)))
    (mlist-of (mapcar #'(lambda (place) (aref items (1- place))) (cdr places)))))

(defun $others_among (size chosen)
  "The numbers from 1 to size that are not chosen."
  (let ((taken (make-array (1+ size) :initial-element nil)) (others nil))
    (dolist (i (cdr chosen)) (setf (aref taken i) t))
    (do ((i size (1- i))) ((< i 1) (mlist-of others)) (or (aref taken i) (push i others)))))

(defun $field (structure name) (nth (place-of-field structure name) structure))

(defun place-of-field (structure name)
  (position (plain-name name) (get (caar structure) 'defstruct-template)))

(defun $altered (structure &rest changes)
  "The structure with other values of some of its fields,  'field = value."
  (let ((altered (copy-list structure)))
    (dolist (change changes altered)
      (setf (nth (place-of-field structure (second change)) altered) (third change)))))

(defun mlist-of (items) (cons '(mlist simp) items))
