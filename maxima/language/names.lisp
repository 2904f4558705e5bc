;;; Names and expressions as text

(in-package :maxima)

(defun $readable (e)
  "One line of Maxima text, dot(q1) spelt as in the scene."
  (remove #\\ (text-of-expression e)))

(defun text-of-expression (e) (coerce (mstring e) 'string))

(defun $unused_name (letters names)
  "The letters, as often as it takes until with a number behind them they name none of the names."
  (let ((once (text-of-expression letters)) (texts (mapcar #'text-of-expression (cdr names))))
    (do ((prefix once (concatenate 'string prefix once)))
        ((notany #'(lambda (text) (numbered-name-p text prefix)) texts)
         (intern-invert-case (concatenate 'string "$" prefix))))))

(defun numbered-name-p (text prefix)
  (and (> (length text) (length prefix))
       (starts-with prefix text)
       (not (find-if-not #'digit-char-p text :start (length prefix)))))

(defvar *mathjson-constants*
  '(($%pi . "Pi") ($%e . "ExponentialE") ($%i . "ImaginaryUnit") ($%gamma . "EulerGamma") (t . "True") (nil . "False")))

(defun $reads_as_constant (name)
  "Return true if a document that contains the name states a number or a truth value."
  (and (member (letters-of-name name) (mapcar #'cdr *mathjson-constants*) :test #'string=) t))
