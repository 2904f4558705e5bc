;;; Names and expressions as text

(in-package :maxima)

(defun $readable (e)
  "One line of Maxima text, dot(q1) spelt as in the scene."
  (remove #\\ (if (plainly-written-p e) (characters-of-name e) (text-of-expression e))))

(defun plainly-written-p (e)
  "Whether it is a name that Maxima shows character by character."
  (and (maxima-name-p e) (not (get e 'op)) (not (get e 'reversealias))))

(defun text-of-expression (e) (coerce (mstring e) 'string))

(defun $plain_name (x)
  "A symbol that is neither a constant, nor an array or declared nonscalar, of which Maxima makes matrices."
  (and ($symbolp x) (not ($constantp x)) (not ($nonscalarp x)) (not (member x '(t nil)))))

(defun $writable_name (x)
  "Letters, digits, _ and %, and what is not ASCII: no character that Maxima writes with a backslash."
  (every #'(lambda (c) (or (alphanumericp c) (find c "_%") (> (char-code c) 127))) (characters-of-name x)))

(defun $reserved_name (x)
  "lambda1, lambda2, ..."
  (and (symbolp x) (numbered-name-p (characters-of-name x) "lambda")))

(defun $unused_name (characters names)
  "The prefix, repeated until with a number after it it is none of the names."
  (let ((once (text-of-expression characters)) (texts (mapcar #'text-of-expression (cdr names))))
    (do ((prefix once (concatenate 'string prefix once)))
        ((not (any-of-p #'(lambda (text) (numbered-name-p text prefix)) texts))
         (intern-invert-case (concatenate 'string "$" prefix))))))

(defun numbered-name-p (text prefix)
  (and (> (length text) (length prefix))
       (starts-with prefix text)
       (not (find-if-not #'digit-char-p text :start (length prefix)))))

(defvar *mathjson-constants*
  '(($%pi . "Pi") ($%e . "ExponentialE") ($%i . "ImaginaryUnit") ($%gamma . "EulerGamma") (t . "True") (nil . "False")))

(defvar *names-of-constants*
  (mapcar #'(lambda (constant) (intern-invert-case (concatenate 'string "$" (cdr constant)))) *mathjson-constants*))

(defun $reads_as_constant (name)
  "Return true if a document that contains the name states a number or a truth value."
  (and (member name *names-of-constants*) t))
