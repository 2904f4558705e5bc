;;; A table in a CSV file: two numbers a line, t and u
;;;
;;; The file is looked for beside the one that names it. Empty lines and those that begin with # are
;;; passed over, and so is a first line without any number, which names the columns. A number is
;;; read as the fraction that its decimal digits say.

(in-package :maxima)

(defvar *largest-exponent* 400 "Of a number in a file: more than doubles reach.")

(defun $rows_of_csv (name)
  "[[t, u], ...]"
  (let ((path (beside-the-scene name)) (number 0) (rows nil) (begun nil))
    (unless (and (probe-file path) (pathname-name (probe-file path)))
      (merror "table: there is no file ~M beside the scene" name))
    (with-open-file (in path)
      (do ((line (read-line in nil) (read-line in nil))) ((null line))
        (incf number)
        (let ((text (trimmed (if (= number 1) (without-byte-order-mark line) line))))
          (unless (or (string= text "") (char= (char text 0) #\#))
            (let* ((cells (mapcar #'trimmed (split-at-commas text)))
                   (numbers (mapcar #'decimal-fraction cells)))
              (when (or begun (some #'identity numbers))
                (push (row-of-csv cells numbers name number) rows))
              (setq begun t))))))
    (cons '(mlist simp) (nreverse rows))))

(defun row-of-csv (cells numbers name line)
  (let ((bad (position nil numbers)))
    (cond (bad (merror "table: ~M, line ~M: '~M' is no number" name line (nth bad cells)))
          ((/= (length numbers) 2)
           (merror "table: ~M, line ~M: a line must hold two numbers, t and u; it holds ~M" name line (length numbers)))
          (t (cons '(mlist simp) (mapcar #'maxima-fraction numbers))))))

(defun beside-the-scene (name)
  (if (or (not (stringp $load_pathname)) (char= (char (concatenate 'string name " ") 0) #\/))
      name
      (concatenate 'string ($pathname_directory $load_pathname) name)))

(defun without-byte-order-mark (line)
  "What spreadsheets write before the first character, as one character or as the three bytes of UTF-8."
  (subseq line (or (position-if-not #'(lambda (c) (member (char-code c) '(239 187 191 65279))) line) (length line))))

(defun trimmed (text) (string-trim '(#\Space #\Tab #\Return #\Newline) text))

(defun split-at-commas (text)
  (let ((comma (position #\, text)))
    (if comma
        (cons (subseq text 0 comma) (split-at-commas (subseq text (1+ comma))))
        (list text))))

(defun decimal-fraction (text)
  "-12.5e-3 as the fraction that it is; nil for what is no number."
  (let* ((e (position-if #'(lambda (c) (find c "eE")) text))
         (mantissa (signed-parts (subseq text 0 e)))
         (exponent (if e (whole-number (subseq text (1+ e))) 0)))
    (when (and mantissa exponent (<= (abs exponent) *largest-exponent*))
      (* mantissa (expt 10 exponent)))))

(defun signed-parts (text)
  (let* ((signed (and (plusp (length text)) (find (char text 0) "+-")))
         (digits (if signed (subseq text 1) text))
         (point (position #\. digits))
         (whole (subseq digits 0 point))
         (part (if point (subseq digits (1+ point)) "")))
    (when (and (plusp (+ (length whole) (length part))) (every #'digit-char-p whole) (every #'digit-char-p part))
      (* (if (and signed (char= (char text 0) #\-)) -1 1)
         (/ (parse-integer (concatenate 'string "0" whole part)) (expt 10 (length part)))))))

(defun whole-number (text)
  (let ((digits (if (and (plusp (length text)) (find (char text 0) "+-")) (subseq text 1) text)))
    (when (and (plusp (length digits)) (< (length digits) 5) (every #'digit-char-p digits))
      (parse-integer text :start (if (char= (char text 0) #\+) 1 0)))))

(defun maxima-fraction (number)
  (if (integerp number) number (list '(rat simp) (numerator number) (denominator number))))
