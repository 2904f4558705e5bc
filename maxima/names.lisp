;;; Names and expressions as text

(in-package :maxima)

(defun $readable (e)
  "One line of Maxima text, dot(q1) spelt as in the scene."
  (remove #\\ (text-of-expression e)))

(defun text-of-expression (e) (coerce (mstring e) 'string))

(defun $unused_name (letters names)
  "The letters, as often as it takes until with a number behind them they name none of the names."
  (let* ((once (text-of-expression letters)) (prefix once))
    (dolist (name (cdr names) (intern-invert-case (concatenate 'string "$" prefix)))
      (let ((text (text-of-expression name)))
        (do () ((not (numbered-name-p text prefix)))
          (setq prefix (concatenate 'string prefix once)))))))

(defun numbered-name-p (text prefix)
  (and (> (length text) (length prefix))
       (starts-with prefix text)
       (not (find-if-not #'digit-char-p text :start (length prefix)))))
