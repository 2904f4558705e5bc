;;; Parts of an expression that are not real: what a description must not contain
;;;
;;; Text, truth values, %i, infinities, lists, relations and constants such as log(-2) and asin(2).

(in-package :maxima)

(defvar *unreal-symbols* '($%i $inf $minf $infinity $und $ind $unknown t nil))
(defvar *unreal-operators* '(mlist $matrix $set mequal mnotequal mlessp mleqp mgreaterp mgeqp mand mor mnot lambda
                             $body $marked $connection))

(defvar *rounded-imaginary-part* 1d-20 "What rounding leaves of a zero imaginary part.")

(defvar *partial-functions* '(mexpt %log %asin %acos %acosh %atanh %asec %acsc %asech %acoth)
  "Functions with real arguments and no real value there.")

(defun $unreal_parts (e)
  "A list of the first part that is not real, empty if there is none."
  (cons '(mlist) (catch 'unreal (require-real-parts e) nil)))

(defun $unreal_parts_in_entry (e &optional in-equation)
  "The same of all that the lists of an entry hold, and the equations that are in no other one."
  (if (or ($listp e) (and ($equationp e) (not in-equation)))
      (dolist (part (cdr e) '((mlist)))
        (let ((found ($unreal_parts_in_entry part (or in-equation ($equationp e)))))
          (when (cdr found) (return found))))
      ($unreal_parts e)))

(defun require-real-parts (e)
  (cond ((or (stringp e) (and (symbolp e) (member e *unreal-symbols*))) (throw 'unreal (list e)))
        ((or (atom e) (member (caar e) '(bigfloat rat $cubic_spline))) nil)
        ((member (caar e) *unreal-operators*) (throw 'unreal (list e)))
        ((eq (caar e) 'mcond)
         (do ((rest (cdr e) (cddr rest))) ((null rest)) (if (second rest) (require-real-parts (second rest)))))
        (t (mapc #'require-real-parts (cdr e))
           (if (and (member (caar e) *partial-functions*) (null (cdr ($listofvars e))) (not (real-constant-p e)))
               (throw 'unreal (list e))))))

(defun real-constant-p (e)
  (let* (($errormsg nil)
         (found (errset ($rectform ($bfloat e))))
         (imaginary (if found ($float ($imagpart (car found))))))
    (and found (not (and (floatp imaginary) (> (abs imaginary) *rounded-imaginary-part*))))))

(defun $partial_functions_of (names e)
  "The powers, roots, logarithms and inverse functions in an expression that contain these names and no others."
  (let ((found nil) (met (make-hash-table :test 'equal)) (known (cdr names)))
    (labels ((contents (e)
               (cond ((atom e) (if (and (symbolp e) (not ($constantp e))) (if (member e known) 'known 'other)))
                     (t (let ((inside (remove nil (mapcar #'contents (cdr e)))))
                          (cond ((member 'other inside) 'other)
                                (inside (if (member (caar e) *partial-functions*) (keep e)) 'known))))))
             (keep (e) (or (gethash e met) (setf (gethash e met) t found (cons e found)))))
      (contents e))
    (mlist-of (nreverse found))))
