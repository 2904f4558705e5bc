;;; A table in a CSV file: two numbers a line, t and u
;;;
;;; Empty lines and those that begin with # are skipped, and so is a first line without any number. A number, which
;;; may stand in quotes, is read as the fraction with its decimal digits.

(in-package :maxima)

(defvar *largest-exponent* 400 "Of a number in a file: more than doubles reach.")

(defun $rows_of_csv (name)
  "[[t, u], ...]"
  (let ((number 0) (rows nil) (begun nil) (before nil))
    (dolist (line (lines-of-table name))
      (incf number)
      (let* ((cells (cells-of line name number)) (numbers (mapcar #'decimal-fraction cells)))
        (when (or (and begun cells) (some #'identity numbers))
          (require-row line cells numbers name number)
          (require-later before cells numbers name number)
          (push (cons '(mlist simp) (mapcar #'maxima-number numbers)) rows)
          (setq before (cons (first numbers) (first cells))))
        (if cells (setq begun t))))
    (cons '(mlist simp) (nreverse rows))))

(defun lines-of-table (name)
  (let ((path (beside-the-scene name)) (lines nil))
    (unless (and (probe-file path) (pathname-name (probe-file path))) ($refuse '$missing_table_file name))
    (with-open-file (in path)
      (do ((text (read-line in nil) (read-line in nil))) ((null text))
        (dolist (line (split-at #\Return (string-right-trim '(#\Return) text))) (push line lines))))
    (let ((lines (nreverse lines)))
      (if lines (cons (without-byte-order-mark (first lines)) (rest lines))))))

(defun cells-of (line name number)
  "Nil for a line without any, empty or behind a #."
  (if (find (code-char 0) line) ($refuse '$null_in_table_file name number))
  (let ((text (trimmed line)))
    (unless (or (string= text "") (char= (char text 0) #\#))
      (mapcar #'unquoted (split-at #\, text)))))

(defun require-row (text cells numbers name line)
  (let ((bad (position nil numbers)))
    (cond ((some #'separated-otherwise-p cells)
           ($refuse '$line_without_comma name line (shortened-text (trimmed text))))
          (bad ($refuse '$number_in_table_file name line (shortened-text (nth bad cells))))
          ((some #'beyond-double-p numbers) ($refuse '$large_number_in_table_file name line))
          ((/= (length numbers) 2) ($refuse '$columns_of_table_file name line (length numbers))))))

(defun beyond-double-p (x) (> (abs x) (rational most-positive-double-float)))

(defun require-later (before cells numbers name line)
  "BEFORE is the time of the row before, with its text; nil for the first row."
  (if (and before (<= (first numbers) (car before)))
      ($refuse '$times_of_table_file name line
                (shortened-text (first cells)) (shortened-text (cdr before)))))

(defun separated-otherwise-p (cell)
  "Whether there is a semicolon, a tab or a blank where only a comma may stand."
  (and (some #'digit-char-p cell) (find-if #'(lambda (c) (find c '(#\; #\Tab #\Space))) cell)))

(defun shortened-text (text) (if (> (length text) 40) (concatenate 'string (subseq text 0 40) "...") text))

(defun beside-the-scene (name)
  (if (or (not (stringp $load_pathname)) (char= (char (concatenate 'string name " ") 0) #\/))
      name
      (concatenate 'string ($pathname_directory $load_pathname) name)))

(defun without-byte-order-mark (line)
  "What spreadsheets write before the first character, as one character or as the three bytes of UTF-8."
  (subseq line (or (position-if-not #'(lambda (c) (member (char-code c) '(239 187 191 65279))) line) (length line))))

(defun trimmed (text) (string-trim '(#\Space #\Tab #\Return #\Newline) text))
(defun unquoted (cell) (string-trim '(#\") (trimmed cell)))

(defun split-at (mark text)
  (let ((parts nil) (begin 0))
    (do ((place (position mark text) (position mark text :start begin)))
        ((null place) (nreverse (cons (subseq text begin) parts)))
      (push (subseq text begin place) parts)
      (setq begin (1+ place)))))

(defun decimal-fraction (text)
  "Return a number such as -12.5e-3 as a fraction, or nil for another text."
  (let* ((e (position-if #'(lambda (c) (find c "eE")) text))
         (mantissa (signed-parts (subseq text 0 e)))
         (exponent (if e (ignore-errors (parse-integer text :start (1+ e))) 0)))
    (when (and mantissa exponent (<= (abs exponent) *largest-exponent*)) (* mantissa (expt 10 exponent)))))

(defun signed-parts (text)
  "Return the fraction with these digits, sign and point, or nil."
  (let ((point (position #\. text)) (number (ignore-errors (parse-integer (remove #\. text :count 1)))))
    (if (and number (not (find-if #'(lambda (c) (find c "+-")) text :start 1)))
        (/ number (expt 10 (if point (- (length text) point 1) 0))))))
