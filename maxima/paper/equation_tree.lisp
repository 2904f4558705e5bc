;;; The text of an equation as a tree, in the shape of the record's expressions (record/mathjson.lisp).
;;;
;;; The text is parsed and nothing is done to it: terms, factors and signs stay where they are
;;; printed. Besides sums, products, quotients and powers a tree holds Equal, NotEqual, List,
;;; Subscript, Apply, Factorial, Determinant, Dot, Ddot, Dddot, Rate and Partial.

(in-package :maxima)

(defvar *printed-heads*
  '((mequal . "Equal") (mnotequal . "NotEqual") (mlist . "List") (mplus . "Add") (mminus . "Negate")
    (mtimes . "Multiply")
    (mquotient . "Divide") (mexpt . "Power") (mfactorial . "Factorial") (mqapply . "Apply")
    ($exp . "Exp") (%exp . "Exp") ($det . "Determinant")
    ($dot . "Dot") ($ddot . "Ddot") ($dddot . "Dddot") ($rate . "Rate") ($partial . "Partial")))

(defun $equation_tree (text) (printed-tree ($parse_string text)))

(defun printed-tree (e)
  (cond ((integerp e) e)
        ((symbolp e) ($sconcat e))
        ((atom e) ($refuse '$not_in_equation e))
        ((member 'array (car e)) (printed-application "Subscript" (cons (caar e) (cdr e))))
        ((member (caar e) '(mtimes mquotient)) (sign-first (printed-application (printed-head e) (cdr e))))
        ((printed-head e) (printed-application (printed-head e) (cdr e)))
        (t ($refuse '$not_printed_language e))))

(defun printed-head (e) (cdr (assoc (caar e) *printed-heads*)))
(defun printed-application (head arguments) `(($json_array) ,head ,@(mapcar #'printed-tree arguments)))

;;; Maxima reads  -a*b  as  (-a)*b; on paper the sign is that of the whole term.
(defun sign-first (product)
  (destructuring-bind (array head first . others) product
    (if (and (consp first) (equal (second first) "Negate"))
        `(,array "Negate" (,array ,head ,(third first) ,@others))
        product)))
