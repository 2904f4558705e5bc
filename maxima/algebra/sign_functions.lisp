;;; Functions that are analytic while certain signs stay the same, written with these signs
;;;
;;;     |g| = s g             max(a, b) = (1 + s)/2 a + (1 - s)/2 b    hstep(g) = (1 + s)/2
;;;     signum(g) = s         min(a, b) = (1 - s)/2 a + (1 + s)/2 b    unit_step(g) = (s + s^2)/2
;;;
;;;     if g > 0 then X else Y = w X + (1 - w) Y,  w = (s + s^2)/2;  if g >= 0:  w = 1 + (s - s^2)/2
;;;
;;; where s is the sign of g, of a - b, a symbol for each such switching function, whose square is 1. They are in the
;;; order of their symbols, in which a function may contain the symbols before it. Written openly, |g| and signum(g)
;;; stay, and w is 0 or 1 also where g is zero.
;;;
;;; On g = 0 a motion slides with an amount s between -1 and 1 if it is linear in s. In friction of the speed, as
;;; exp(-|v|) signum(v), |v| is signum(s) v, so that only the amount itself is s.
;;;
;;; g may vanish identically for some values of the signs in it, as max(0, x) does where x < 0. Such a g is written as a
;;; sum over these values; its sign is 0 there.

(in-package :maxima)

(defvar *sign-prefix* '$sign)
(defvar *signs-met* nil "List of (symbol . switching function), last first.")
(defvar *written-openly* nil "Whether signs stay signum(g).")
(defvar *at-zeros* nil "Whether signs are 0, too, so that their squares are not 1.")
(defvar *sizes-apart* nil "Whether |g| is signum(s) g, with which it is zero where the sign s has no value.")

(defun $written_openly (expression) (let ((*written-openly* t)) (with-signs expression)))

(defun $written_with_signs (expressions prefix)
  "[[[sign1, g1], ...], the expressions with the symbols prefix1, ... for the signs of g1, ...]."
  (let* ((*sign-prefix* prefix) (*signs-met* nil) (written (with-signs expressions)))
    (list '(mlist)
          (cons '(mlist) (mapcar #'(lambda (met) (list '(mlist) (car met) (cdr met)))
                                 (reverse *signs-met*)))
          written)))

(defun $written_with_sizes (expressions signs)
  "The expressions with these symbols, [s, g], for the signs of all functions in them, and |g| as signum(s) g."
  (let ((*sizes-apart* t)
        (*signs-met* (reverse (mapcar #'(lambda (met) (cons (second met) (third met))) (cdr signs)))))
    (with-signs expressions)))

(defun with-signs (e)
  (if (or (atom e) (member 'array (car e)))
      e
      (let ((operator (caar e)))
        (cond ((eq operator 'mcond) (conditional-with-signs (cdr e)))
              ((root-of-excess-p e) (conditional-with-signs (excess-in-parts (third (second e)) (third e))))
              ((root-of-size-p e) (power (size-with-sign-met (with-signs (second (second e)))) (third e)))
              ((eq operator 'mabs) (absolute-value (with-signs (second e))))
              ((eq operator '%signum) (sign-or-zero (with-signs (second e))))
              ((power-of-sign-p e)
               (let ((sign (with-signs (second e)))) (if (evenp (third e)) (square-of-sign sign) sign)))
              ((member operator '($max %max)) (extremum 1 (mapcar #'with-signs (cdr e))))
              ((member operator '($min %min)) (extremum -1 (mapcar #'with-signs (cdr e))))
              ((member operator '($hstep %hstep)) (weight-of-sign (sign-or-zero (with-signs (second e)))))
              ((member operator '($unit_step %unit_step)) (weight-if-positive (with-signs (second e))))
              (t (let ((parts (mapcar #'with-signs (cdr e))))
                   (if (same-items-p parts (cdr e))
                       e
                       (simplifya (cons (list operator) parts) t))))))))

;; A root of s g would have no value where a step ends behind the zero of g.
(defun size-with-sign-met (g) (sign-of-function g) (take '(mabs) g))
(defun root-of-size-p (e) (root-of-p '(mabs) e))
(defun root-of-p (operators e)
  (and (eq (caar e) 'mexpt) ($ratnump (third e)) (not (integerp (third e))) (consp (second e))
       (member (caar (second e)) operators)))

;; The root of max(0, g) has no slope where g is negative, as that of a product of g and 0.
(defun root-of-excess-p (e)
  (and (root-of-p '($max %max) e) (plusp ($num (third e))) (= (length (second e)) 3) (eql (second (second e)) 0)))

(defun excess-in-parts (g exponent) (list (take '(mgreaterp) g 0) (power g exponent) t 0))

;; To Maxima it is the real root, of g < 0 as well: signum(g) |g|^(p/q) if p is odd, |g|^(p/q) if p is even.
(defun odd-root-p (e)
  "Whether e is g^(p/q) with an odd q."
  (and (eq (caar e) 'mexpt) ($ratnump (third e)) (not (integerp (third e))) (oddp ($denom (third e)))))

(defun power-of-sign-p (e)
  (and (eq (caar e) 'mexpt) (consp (second e)) (eq (caar (second e)) '%signum)
       (integerp (third e)) (plusp (third e))))

(defun may-be-negative-p (g) (member ($csign g) '($neg $nz $pn $pnz)))

(defun extremum (side arguments)
  (reduce #'(lambda (a b)
              (let ((sign (mul side (sign-or-zero (sub a b)))))
                (add (mul (weight-of-sign sign) a) (mul (weight-of-sign (neg sign)) b))))
          arguments))

(defun absolute-value (g)
  (cond (*written-openly* (take '(mabs) g))
        (*sizes-apart* (mul g (take '(%signum) (sign-of-function g))))
        (t (mul g (sign-of-function g)))))
(defun weight-of-sign (sign) (div (add 1 sign) 2))

;; Of an if that it cannot decide Maxima evaluates the first condition alone: what is called behind it is not called
;; yet.
(defun $with_branches_evaluated (e)
  "The expression with the functions called that the branches of an if in it call."
  (cond ((or (atom e) (member 'array (car e))) e)
        ((eq (caar e) 'mcond)
         (cons (car e) (mapcar #'(lambda (part) ($with_branches_evaluated (if (calls-p part) (meval part) part)))
                               (cdr e))))
        (t (let ((parts (mapcar #'$with_branches_evaluated (cdr e))))
             (if (same-items-p parts (cdr e)) e (simplifya (cons (car e) parts) t))))))

(defun calls-p (e)
  "Whether an expression calls a function that Maxima, the library or the scene defines, and does not only simplify."
  (and (consp e)
       (consp (car e))
       (or (let ((operator (caar e)))
             (and (symbolp operator)
                  (not (get operator 'operators))
                  (not (eq operator 'mcond))
                  (or (mgetl operator '(mexpr mmacro))
                      (getl operator '(mfexpr mfexpr* mfexpr*s))
                      (and (char= (char (symbol-name operator) 0) #\$) (fboundp operator)))))
           (some #'calls-p (cdr e)))))

;; A branch of weight zero is dropped where the signs are put in; elsewhere it has a value, too. Many branches are added
;; by halves: the depth of the sum grows as the logarithm of their number.
(defun conditional-with-signs (clauses) (values (sum-of-branches (weighted-branches clauses 1 nil))))

(defun weighted-branches (clauses outer outer-names)
  "The branches as (weight . value). Clauses are condition, value, ... as Maxima keeps them. outer: their weight."
  (destructuring-bind (condition value &rest others) clauses
    (let ((weight (condition-weight condition)))
      (cond ((null value) ($refuse '$if_without_else))
            ((and (eql weight 1) (consp value) (eq (caar value) 'mcond))
             (weighted-branches (cdr value) outer outer-names))
            ((eql weight 1) (acons 1 (value-of-branch value outer outer-names) nil))
            (t (let ((names (append (cdr ($listofvars condition)) outer-names)))
                 (acons weight
                        (value-of-branch value (mul outer weight) names)
                        (weighted-branches others (mul outer (sub 1 weight)) names))))))))

(defvar *within* nil "(weight . names): where signs are symbols, the branch whose value is written.")

(defun further-within (weight names) (cons (mul (or (car *within*) 1) weight) (append names (cdr *within*))))

(defun value-of-branch (value weight names)
  (let ((*within* (unless *written-openly* (further-within weight names))))
    (restricted (with-signs value) weight names)))

(defun sum-of-branches (branches)
  "The value of the first branch whose weight is 1, or 0; and 1 where there is none, otherwise 0."
  (if (rest branches)
      (let ((middle (floor (length branches) 2)))
        (multiple-value-bind (value rest) (sum-of-branches (subseq branches 0 middle))
          (multiple-value-bind (later-value later-rest) (sum-of-branches (subseq branches middle))
            (values (add value (mul rest later-value)) (mul rest later-rest)))))
      (destructuring-bind (weight . value) (first branches) (values (mul weight value) (sub 1 weight)))))

(defun restricted (e weight names)
  "The expression whose functions of what the condition decides have values, not too large, where its weight is zero."
  (if (or (atom e) (member 'array (car e)) (every #'(lambda (name) (free e name)) names))
      e
      (let ((parts (mapcar #'(lambda (part) (restricted part weight names)) (cdr e))))
        (cond ((exponential-p e) (power (first parts) (mul weight (second parts))))
              ((member (caar e) '(%cosh %sinh)) (take (list (caar e)) (mul weight (first parts))))
              ((and (partial-p e) (some #'(lambda (name) (not (free (second e) name))) names))
               (simplifya (list* (car e) (with-value-inside (caar e) (first parts) weight) (rest parts)) nil))
              ((same-items-p parts (cdr e)) e)
              (t (simplifya (cons (list (caar e)) parts) t))))))

(defun exponential-p (e) (and (eq (caar e) 'mexpt) ($constantp (second e))))

(defun partial-p (e)
  (and (member (caar e) *partial-functions*)
       (not (and (eq (caar e) 'mexpt) (integerp (third e)) (plusp (third e))))))

(defun with-value-inside (operator x weight)
  (let ((inside (if (member operator '(%acosh %asec %acsc %acoth)) 2 1//2)))
    (add (mul weight x) (mul (sub 1 weight) inside))))

(defun condition-weight (condition)
  "1 where the condition holds, 0 where it does not."
  (cond ((eq condition t) 1)
        ((null condition) 0)
        ((atom condition) (refuse-condition condition))
        (t (let ((parts (cdr condition)))
             (case (caar condition)
               (mgreaterp (weight-if-greater (first parts) (second parts)))
               (mlessp (weight-if-greater (second parts) (first parts)))
               (mgeqp (sub 1 (weight-if-greater (second parts) (first parts))))
               (mleqp (sub 1 (weight-if-greater (first parts) (second parts))))
               (mand (muln (mapcar #'condition-weight parts) nil))
               (mor (sub 1 (muln (mapcar #'(lambda (part) (sub 1 (condition-weight part))) parts) nil)))
               (mnot (sub 1 (condition-weight (first parts))))
               (t (refuse-condition condition)))))))

;;; The weights of a > b and of a < b; those of a >= b and of a <= b are 1 less these.
(defun weight-if-greater (a b) (weight-if-positive (with-signs (sub a b))))
(defun weight-if-positive (g) (let ((sign (sign-or-zero g))) (div (add sign (square-of-sign sign)) 2)))
(defun refuse-condition (condition) ($refuse '$condition_without_comparison condition))

(defun square-of-sign (sign) (without-squares (power sign 2)))

(defun without-squares (e)
  "A polynomial in the signs, linear in each, where the signs are 1 or -1."
  (if (or *written-openly* *at-zeros*)
      e
      (reduce #'(lambda (e symbol) (maxima-substitute 1 (power symbol 2) e)) (signs-in e) :initial-value ($expand e))))

(defparameter *most-signs* 6 "Within a function, so that it is looked at for all their values.")

(defun sign-or-zero (g)
  "The sign of g, 0 where g vanishes identically."
  (if *written-openly*
      (let* ((*written-openly* nil) (*at-zeros* t) (*signs-met* nil) (sign (sign-by-values (with-signs g))))
        (if sign (openly sign) (let ((*written-openly* t)) (sign-of-function g))))
      (or (sign-by-values (in-signs g)) (sign-of-function g))))

(defun sign-by-values (g)
  "nil where g vanishes for no values of the signs in it."
  (let ((signs (signs-in g)) ($ratprint nil))
    (cond ((zerop1 g) 0)
          ((and signs (<= (length signs) *most-signs*) (vanishes-for-signs-p g signs))
           ($ratsimp (without-squares (sum-over-signs g g signs)))))))

(defun signs-in (g) (remove-if #'(lambda (symbol) (free g symbol)) (mapcar #'car *signs-met*)))

(defun vanishes-for-signs-p (g signs)
  (if signs
      (some #'(lambda (value) (vanishes-for-signs-p (maxima-substitute value (first signs) g) (rest signs))) '(1 -1))
      (zerop1 ($ratsimp g))))

(defvar *values* nil "List of (symbol . value), by which a function is written.")

(defun sum-over-signs (g guarded signs)
  "The sign of g by the values of the signs in it. guarded: g with these signs left in the arguments of guards."
  (if signs
      (let ((symbol (first signs)))
        (addn (mapcar #'(lambda (value)
                          (let* ((*values* (acons symbol value *values*))
                                 (part (sum-over-signs (maxima-substitute value symbol g)
                                                       (outside-guards value symbol guarded) (rest signs))))
                            (mul (weight-of-value value symbol) (maxima-substitute value symbol part))))
                      (if *at-zeros* '(1 -1 0) '(1 -1)))
              nil))
      (let ((simplified ($ratsimp g)))
        (if (zerop1 simplified) 0 (sign-of-function (if (alike1 g guarded) simplified guarded))))))

(defun outside-guards (value symbol e)
  "The value in place of a sign, but where functions have no value, or one too large, for another sign."
  (cond ((eq e symbol) value)
        ((or (atom e) (guarded-p e) (free e symbol)) e)
        (t (simplifya (cons (list (caar e))
                            (mapcar #'(lambda (part) (outside-guards value symbol part)) (cdr e)))
                      nil))))

(defun guarded-p (e) (or (partial-p e) (exponential-p e) (member (caar e) '(%cosh %sinh))))

(defun weight-of-value (value sign)
  "1 where a sign has the value, 0 where it has another one."
  (let ((square (power sign 2))) (if (zerop1 value) (sub 1 square) (div (add (mul value sign) square) 2))))

(defun openly (e)
  (dolist (met *signs-met* e)
    (setq e (maxima-substitute (simplifya (list '(%signum) (cdr met)) nil) (car met) e))))

(defun sign-of-function (g)
  "The sign of g, by a number and the symbols of the functions that it is a product of."
  (let ((sign (signs-of-bases (simplifya (list '(%signum) (in-signs g)) nil))))
    (if *written-openly* sign (with-sign-symbols sign))))

(defun signs-of-bases (sign)
  "A sign by values: that of a root of even order is that of what is under the root."
  (cond ((atom sign) sign)
        ((eq (caar sign) '%signum)
         (let* ((g (second sign)) (by-values (by-values (if (even-root-p g) (second g) g))))
           (if (alike1 by-values g) sign (signs-of-bases (simplifya (list '(%signum) by-values) nil)))))
        (t (let ((parts (mapcar #'signs-of-bases (cdr sign))))
             (if (same-items-p parts (cdr sign)) sign (simplifya (cons (list (caar sign)) parts) t))))))

(defun by-values (g)
  (reduce #'(lambda (g met) (outside-guards (cdr met) (car met) g)) *values* :initial-value g))

(defun even-root-p (e) (and (consp e) (eq (caar e) 'mexpt) ($ratnump (third e)) (evenp ($denom (third e)))))

(defun in-signs (g)
  "A function as it is written where sizes are not apart: it is met by what it is then."
  (if *sizes-apart*
      (reduce #'(lambda (g symbol) (maxima-substitute symbol (take '(%signum) symbol) g))
              (mapcar #'car *signs-met*) :initial-value g)
      g))

(defun with-sign-symbols (sign)
  (cond ((atom sign) sign)
        ((eq (caar sign) '%signum) (sign-symbol (within-branch (second sign))))
        (t (simplifya (cons (list (caar sign)) (mapcar #'with-sign-symbols (cdr sign))) t))))

(defun within-branch (g) (if *within* (restricted g (car *within*) (cdr *within*)) g))

(defun sign-symbol (g)
  (let ((met (find-if #'(lambda (met) (alike1 (cdr met) g)) *signs-met*)))
    (if met
        (car met)
        (let ((symbol ($concat *sign-prefix* (1+ (length *signs-met*)))))
          (push (cons symbol g) *signs-met*)
          symbol))))

;;; 1/cosh(x) decays where cosh(x) leaves the range of numbers: as 2 E/(1 + E^2) with E = exp(-|x|) it is small there,
;;; and so are its time derivatives.

(defun $decaying (e)
  "The expression with the reciprocals of cosh in it written by what decays."
  (cond ((or (atom e) (member 'array (car e))) e)
        ((and (eq (caar e) 'mexpt) (consp (second e)) (eq (caar (second e)) '%cosh)
              (integerp (third e)) (minusp (third e)))
         (power (decaying-sech ($decaying (second (second e)))) (- (third e))))
        ((eq (caar e) '%sech) (decaying-sech ($decaying (second e))))
        (t (simplifya (cons (list (caar e)) (mapcar #'$decaying (cdr e))) nil))))

(defun decaying-sech (x)
  (let ((decay (power '$%e (neg (take '(mabs) x))))) (div (mul 2 decay) (add 1 (power decay 2)))))
