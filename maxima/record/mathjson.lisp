;;; Maxima expressions and plain data as JSON text
;;;
;;; An expression becomes a tree in MathJSON's shape: ["Add", "q1", ["Multiply", 2, "dot(q1)"]]. Data are
;;; json_object([name, value], ...), json_array(value, ...), json_expression(expression), strings, booleans, integers
;;; and json_null. Numbers are exact: an integer beyond 2^53 and every float are strings of decimal digits.

(in-package :maxima)

(defvar *mathjson-functions*
  '((mtimes . "Multiply") (mquotient . "Divide") (mminus . "Negate") (mabs . "Abs") (%log . "Ln") (%signum . "Sign")
    (%sin . "Sin") (%cos . "Cos") (%tan . "Tan") (%sinh . "Sinh") (%cosh . "Cosh") (%tanh . "Tanh")
    (%asin . "Arcsin") (%acos . "Arccos") (%atan . "Arctan") ($atan2 . "Arctan2") (%atan2 . "Arctan2")
    (%asinh . "Arsinh") (%acosh . "Arcosh") (%atanh . "Artanh")
    (%sec . "Sec") (%csc . "Csc") (%cot . "Cot") (%sech . "Sech") (%csch . "Csch") (%coth . "Coth")
    (%asec . "Arcsec") (%acsc . "Arccsc") (%acot . "Arccot")
    (%asech . "Arsech") (%acsch . "Arcsch") (%acoth . "Arcoth") (%erf . "Erf") (%erfc . "Erfc")
    (%bessel_j . "BesselJ") (%bessel_y . "BesselY") (%bessel_i . "BesselI") (%bessel_k . "BesselK")
    (%gamma . "Gamma") (%zeta . "Zeta")
    (%airy_ai . "AiryAi") (%airy_bi . "AiryBi") (%airy_dai . "AiryAiPrime") (%airy_dbi . "AiryBiPrime")
    (%jacobi_sn . "JacobiSn") (%jacobi_cn . "JacobiCn") (%jacobi_dn . "JacobiDn")))

(defvar *json-of-names* nil "How each symbol is written that the document has met.")

(defun $write_json (tree file)
  (let ((*print-base* 10) (*print-radix* nil) ; obase : 8 of a scene is none of a document's
        (*json-of-names* (make-hash-table)))
    (write-file file (with-output-to-string (out) (write-json tree out) (terpri out)))))

;;; All at once: GCL hands each part to the system as it comes, by two calls.
(defun write-file (file text)
  (with-open-file (out file :direction :output :if-exists :supersede) (write-string text out))
  file)

(defun write-json (tree out)
  (cond ((stringp tree) (write-json-string tree out))
        ((integerp tree) (princ tree out))
        ((eq tree t) (write-string "true" out))
        ((eq tree nil) (write-string "false" out))
        ((eq tree '$json_null) (write-string "null" out))
        ((eq (caar tree) '$json_object) (write-members (cdr tree) out))
        ((eq (caar tree) '$json_array) (write-separated (cdr tree) #\[ #\] #'write-json out))
        ((eq (caar tree) '$json_expression) (write-mathjson (cadr tree) out))
        (t ($refuse '$data_not_written tree))))

(defun $json_rows (rows)
  "Each [expression, ...] as an array."
  (cons '($json_array)
        (mapcar #'(lambda (row)
                    (cons '($json_array) (mapcar #'(lambda (e) (list '($json_expression) e)) (cdr row))))
                (cdr rows))))

(defun write-members (members out)
  (flet ((write-member (member out)
           (write-json-string (second member) out)
           (write-char #\: out)
           (write-json (third member) out)))
    (write-separated members #\{ #\} #'write-member out)))

(defun write-separated (items opening closing writer out)
  (let ((before opening))
    (dolist (item items)
      (write-char before out)
      (funcall writer item out)
      (setq before #\,))
    (if (null items) (write-char opening out)))
  (write-char closing out))

(defun write-json-string (text out)
  (write-char #\" out)
  (write-string (with-escapes text) out)
  (write-char #\" out))

(defun with-escapes (text)
  "The text itself, where nothing is to be escaped."
  (if (dotimes (i (length text)) (if (to-be-escaped-p (char text i)) (return t)))
      (with-output-to-string (out) (map nil #'(lambda (c) (write-string (escaped c) out)) text))
      text))

(defun to-be-escaped-p (c) (or (char= c #\") (char= c #\\) (< (char-code c) 32)))

(defun escaped (c)
  (cond ((char= c #\") "\\\"")
        ((char= c #\\) "\\\\")
        ((< (char-code c) 32) (format nil "\\u~4,'0x" (char-code c)))
        (t (string c))))

(defun write-mathjson (e out)
  (cond ((integerp e) (write-integer e out))
        ((floatp e) (write-number (decimal-digits (rational e) 17) out))
        ((symbolp e) (write-char #\" out) (write-string (json-of-name e) out) (write-char #\" out))
        ((atom e) ($refuse '$expression_not_written e))
        ((eq (caar e) 'rat) (write-tree "Rational" (cdr e) out))
        ((eq (caar e) 'mrat) (write-mathjson ($totaldisrep e) out))
        ((eq (caar e) 'bigfloat) (write-bigfloat e out))
        ((eq (caar e) 'mexpt) (write-power (cadr e) (caddr e) out))
        ((eq (caar e) 'mplus) (write-sum (cdr e) out))
        ((member 'array (car e)) (write-tree "Subscript" (cons (caar e) (cdr e)) out))
        ((polygamma-p e) (write-tree "PolyGamma" (list (second (second e)) (third e)) out))
        ((assoc (caar e) *mathjson-functions*)
         (write-tree (cdr (assoc (caar e) *mathjson-functions*)) (cdr e) out))
        ((write-described e out))
        (t ($refuse '$function_not_written (caar e)))))

(defun write-tree (head arguments out)
  (write-string "[\"" out)
  (write-string head out)
  (write-char #\" out)
  (dolist (a arguments) (write-char #\, out) (write-mathjson a out))
  (write-char #\] out))

(defun polygamma-p (e) (and (eq (caar e) 'mqapply) (eq (caar (second e)) '$psi)))

;;; Maxima's own sums hold no minus signs; those of a motion program do, as differences.
(defun write-sum (terms out)
  (let ((plus nil) (minus nil))
    (dolist (term (reverse terms)) (if (negated-p term) (push (cadr term) minus) (push term plus)))
    (cond ((null minus) (write-tree "Add" plus out))
          ((null plus) (write-tree "Negate" (list (sum-expression minus)) out))
          (t (write-tree "Subtract" (list (sum-expression plus) (sum-expression minus)) out)))))

(defun negated-p (e) (and (consp e) (eq (caar e) 'mminus)))
(defun sum-expression (terms) (if (cdr terms) (cons '(mplus) terms) (car terms)))

(defun write-power (base exponent out)
  (cond ((eq base '$%e) (write-tree "Exp" (list exponent) out))
        ((equal exponent '((rat simp) 1 2)) (write-tree "Sqrt" (list base) out))
        ((and (odd-root-p (list '(mexpt) base exponent)) (may-be-negative-p (simplifya base nil)))
         (write-real-root base exponent out))
        (t (write-tree "Power" (list base exponent) out))))

(defun write-real-root (base exponent out)
  (let ((root (list '(mexpt) (list '(mabs) base) exponent)))
    (write-mathjson (if (oddp (second exponent)) (list '(mtimes) (list '(%signum) base) root) root) out)))

(defun write-integer (n out)
  (if (< (abs n) (expt 2 53)) (princ n out) (write-number (princ-to-string n) out)))

(defun write-number (digits out)
  (write-string "{\"num\":\"" out)
  (write-string digits out)
  (write-string "\"}" out))

(defun write-bigfloat (e out)
  (let ((digits (ceiling (* (car (last (car e))) (log 2d0 10d0)))))
    (write-number (decimal-digits (rational-of-bigfloat e) (+ 2 digits)) out)))

(defun mathjson-symbol (symbol) (or (cdr (assoc symbol *mathjson-constants*)) (characters-of-name symbol)))

(defun json-of-name (symbol)
  (or (gethash symbol *json-of-names*)
      (setf (gethash symbol *json-of-names*) (with-escapes (mathjson-symbol symbol)))))
