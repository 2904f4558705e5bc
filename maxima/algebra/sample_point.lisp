;;; Values of terms of the expression graph at a point, and points on a manifold
;;;
;;; Values are rationals, rounded to 80 digits once they are longer. A sum is zero where its terms cancel to a share of
;;; 10^-20, a cosine where its argument would have to change by such a share. No number is compared with a fixed size,
;;; so that scaling a row or a column changes no rank.
;;;
;;; A point on the manifold f = 0 is found by Newton's method, each correction the shortest. What f leaves of a zero is
;;; 10^-55 then.

(in-package :maxima)

(defvar *digits-at-point* 80)
(defvar *zero-share* (expt 10 -20) "Sums that cancel to less of their largest term are zero.")
(defvar *zero-share-of-constraints* (expt 10 -55))
(defvar *zero-share-of-others* (expt 10 -45) "On the manifold, of constraints that Newton's method did not look at.")
(defvar *zero-share-of-floats* 1d-12)
(defvar *share-of-dependence* (expt 10 -6) "The same of gradients, at a point given in some ten digits.")
(defvar *close* double-float-epsilon "A correction in floating point by less of the largest coordinate is the last.")
(defvar *close-to-root* 1d-9 "The same where the gradients are as dependent as at the root.")
(defvar *small-coordinate* (expt 10 -20))
(defvar *floating* nil "Whether numbers are floating-point ones, for a start.")
(defvar *most-corrections* 400)
(defvar *impatience* 40 "Corrections after which each must be smaller than the one before.")
(defvar *smallest-coordinate* (expt 10 -70))
(defvar *functions-with-zeros* '(%sin %cos %tan %cot %log) "With slope 1 or -1 at their zeros, but for signs and 1/x.")
(defvar *runaway* (expt 10 30) "Of the initial point and its correction: a correction that large is a divergence.")
(defvar *least-gain* 1000 "By how much a correction in floating point must lessen the residuals.")
(defvar *most-refinements* 20)
(defvar *most-halvings* 40 "Of a correction, in a line search.")
(defvar *small-correction* (expt 10 -12) "Of the largest coordinate: a correction that needs no line search.")

(defvar *contraction* 1/16
  "Of a correction: the nonlinearity of the constraints allowed along it, where the initial state is near its root.")

(defvar *starts-on-a-line* '(1/16 -1/16 1/8 -1/8 3/16 -3/16 1/4 -1/4 5/16 -5/16 3/8 -3/8 7/16 -7/16 1/2 -1/2
                             9/16 -9/16 5/8 -5/8 11/16 -11/16 3/4 -3/4 13/16 -13/16 7/8 -7/8 15/16 -15/16 1 -1)
  "Shares of the distance of a root at which the search for nearer ones begins, with one unknown.")

(defvar *starts-around* '(1/4 -1/4 1/2 -1/2 3/4 -3/4 1 -1) "The same along each of several unknowns.")
(defvar *most-unknowns-searched* 12 "Unknowns up to which nearer roots are looked for.")
(defvar *most-corrections-of-search* 20 "From each of these starts.")
(defvar *most-halvings-of-search* 6 "Of each of these corrections.")
(defvar *nearer* 9/10 "Of the distance of a point on a manifold: another one that is on a nearer branch.")

(defstruct sample-point
  (symbols (make-hash-table))              ; symbol -> rational
  (scattered nil)                          ; whether other symbols have values of their own
  (known (make-hash-table)))               ; node number -> rational

(defun $sample_point (equations)
  "The point with  name = rational number."
  (let ((point (make-sample-point)))
    (dolist (e (cdr equations) point)
      (setf (gethash (second e) (sample-point-symbols point)) (rational-of (third e))))))

(defun scattered-value (symbol point)
  "A fraction between 1 and 2 of its own."
  (let ((symbols (sample-point-symbols point)))
    (setf (gethash symbol symbols) (1+ (/ (mod (* 7919 (+ 13 (hash-table-count symbols))) 10007) 10007)))))

(defun $vanish_in_a_point (expressions)
  "Whether all are zero where every symbol has a value of its own."
  (let ((point (make-sample-point :scattered t)) (zero nil))
    (catch 'irregular-point
      (setq zero (all-of-p #'(lambda (e) (zerop (value-at (expression-term e) point))) (cdr expressions))))
    zero))

;;; ---- values ------------------------------------------------------------------------------

(defun value-at (term point)
  (if (zero-term-p term)
      0
      (short-number (* (term-coefficient term) (node-value (term-node term) point)))))

(defun node-value (node point)
  (let ((known (sample-point-known point)))
    (or (gethash (node-number node) known)
        (setf (gethash (node-number node) known) (value-by-parts node point)))))

(defun value-by-parts (node point)
  (case (node-kind node)
    (symbol (or (gethash (node-parts node) (sample-point-symbols point))
                (if (and (sample-point-scattered point) (not ($constantp (node-parts node))))
                    (scattered-value (node-parts node) point))
                (number-from-maxima (node-parts node))))
    (opaque (node-value (node-parts node) point))
    (sum (sum-of-numbers (mapcar #'(lambda (term) (value-at term point)) (node-parts node))))
    (product (let ((value 1))
               (dolist (factor (node-parts node) value)
                 (setq value (short-number
                              (* value (whole-power (node-value (factor-node factor) point)
                                                    (factor-exponent factor))))))))
    (call (value-of-call (car (node-parts node))
                         (mapcar #'(lambda (term) (value-at term point)) (cdr (node-parts node)))))))

(defun sum-of-numbers (numbers)
  (let ((sum (sum-of-all numbers)))
    (if (< (abs sum) (* *zero-share* (largest-of (mapcar #'abs numbers))))
        0
        (short-number sum))))

(defun whole-power (number exponent)
  (if (and (zerop number) (minusp exponent)) (irregular-point))
  (expt number exponent))

(defun value-of-call (operator numbers)
  (let ((value (number-from-maxima (maxima-call operator (mapcar #'maxima-number numbers)))))
    (if (and (member operator *functions-with-zeros*)
             (< (abs value) (* *zero-share* (abs (car numbers)))))
        0
        value)))

(defun number-from-maxima (e)
  (let* (($errormsg nil)
         (fpprec (digits-in-bits (+ *digits-at-point* 10)))
         (found (car (errset (funcall (if *floating* #'$float #'$bfloat) (simplifya e nil))))))
    (cond ((if *floating* (numberp found) (integerp found)) found)
          ((and (not *floating*) (bigfloatp found)) (rational-of-bigfloat found))
          (t (irregular-point)))))

(defun short-number (number)
  (let ((bits (if (floatp number) nil (digits-in-bits *digits-at-point*))))
    (if (or (null bits) (< (+ (integer-length (numerator number)) (integer-length (denominator number))) (* 2 bits)))
        number
        (rounded-to-bits number bits))))

(defun irregular-point () (throw 'irregular-point nil))

(defun $rows_at_point (rows point)
  "Sparse rows [[column, term], ...] in numbers, zeros left out; false where one has no real value."
  (catch 'irregular-point
    (cons '(mlist) (mapcar #'(lambda (row) (maxima-row (row-at-point row point))) (cdr rows)))))

(defun $vanish_on_manifold (terms point)
  "Whether terms are zero at a point that Newton's method has found."
  (let ((*zero-share* *zero-share-of-others*)
        (point (make-sample-point :symbols (sample-point-symbols point)))
        (zero nil))
    (catch 'irregular-point
      (setq zero (all-of-p #'(lambda (term) (zerop (value-at (expression-term term) point))) (cdr terms))))
    zero))

(defun row-at-point (row point)
  "The entries (column . number) that are not zero, in the order of their columns."
  (let ((entries nil))
    (dolist (e (cdr row) (sort entries #'< :key #'car))
      (let ((value (value-at (expression-term (third e)) point)))
        (if (not (zerop value)) (push (cons (second e) value) entries))))))

(defun maxima-row (row)
  (cons '(mlist) (mapcar #'(lambda (e) (list '(mlist) (car e) (maxima-number (cdr e)))) row)))

(defun rows-from-maxima (rows)
  (mapcar #'(lambda (row) (mapcar #'(lambda (e) (cons (second e) (rational-of (third e)))) (cdr row))) (cdr rows)))

;;; ---- Newton's method ---------------------------------------------------------------------

(defvar *equations* nil "Terms that are to vanish.")
(defvar *jacobian* nil "Their gradients by the unknowns, sparse.")
(defvar *unknowns* nil "Symbols.")
(defvar *metric* nil "Sparse rows; nil where corrections are as short as they can be.")

(defun $point_on_manifold (point constraints jacobian coordinates)
  "The point, its coordinates changed until the constraints hold; false where Newton's method does
not get there. constraints: list of terms; jacobian: their gradients by the coordinates, sparse."
  (let ((*zero-share* *zero-share-of-constraints*)
        (*equations* (cdr constraints)) (*jacobian* jacobian) (*unknowns* (cdr coordinates)) (*metric* nil))
    (catch 'irregular-point
      (if (all-of-p #'zerop (residuals-at point))
          (copied-point point)
          (let ((close (point-near-manifold point))) (if close (refined-point close)))))))

(defun residuals-at (point) (mapcar #'(lambda (f) (value-at (expression-term f) point)) *equations*))

(defun point-near-manifold (point &optional damped)
  "The same in floating point, which is quicker; nil where that does not get there."
  (let* ((*floating* t)
         (*zero-share* *zero-share-of-floats*)
         (found (errset (catch 'irregular-point (newton-iteration (converted-point point #'float-of) damped)))))
    (if (car found) (point-with-unknowns-of (car found) point))))

(defun point-with-unknowns-of (found point)
  "The point with its unknowns as they are in another one, in floating point; all else stays exact."
  (let ((moved (copied-point point)))
    (dolist (q *unknowns* moved)
      (setf (gethash q (sample-point-symbols moved)) (rational (coordinate q found))))))

(defun refined-point (close)
  "To all digits: corrections in floating point add several each; Newton's method where they do not."
  (let ((refined (corrected-in-floats close)))
    (if refined (corrected-point refined (make-hash-table)) (newton-iteration close))))

(defun corrected-in-floats (point)
  (let ((*small-coordinate* *smallest-coordinate*) (before nil) (next point)) ; what lands too soon cannot be corrected
    (dotimes (attempt *most-refinements* nil)
      (let* ((point next)
             (residuals (residuals-at point))
             (size (largest-of (cons 0 (mapcar #'abs residuals))))
             (corrections (if (or (null before) (< (* *least-gain* size) before))
                              (corrections-in-floats residuals size point))))
        (cond ((zerop size) (return point))
              ((null corrections) (return nil)))
        (setq before size next (corrected-point point corrections))
        (if (negligible-p corrections residuals point) (return next))))))

;; Sums within a constraint count as zero before it does: its residual may be more than its own share.
(defun negligible-p (corrections residuals point)
  "Whether the corrections are rounding errors, and remove the residuals to first order."
  (and (< (largest-correction corrections) (* *zero-share* (largest-coordinate point)))
       (let* ((*floating* t)
              (*zero-share* *zero-share-of-floats*)
              (rows (catch 'irregular-point (numeric-rows *jacobian* (converted-point point #'float-of)))))
         (and rows (all-of-p #'identity (mapcar #'(lambda (row residual) (removed-p row corrections residual))
                                                rows residuals))))))

(defun removed-p (row corrections residual)
  (let ((terms (mapcar #'(lambda (e) (* (rational (cdr e)) (gethash (car e) corrections 0))) row)))
    (<= (* *least-gain* (abs (+ residual (sum-of-all terms))))
        (+ (abs residual) (sum-of-all (mapcar #'abs terms))))))

(defun corrections-in-floats (residuals size point)
  "Newton's corrections of residuals that are at most so large; nil where floating point has none, or none is needed."
  (let* ((*floating* t)
         (*zero-share* *zero-share-of-floats*)
         (scale (if (plusp size) (expt 2 (binary-magnitude size)))) ; of two alone: few digits are added to coordinates
         (found (if scale
                    (errset (catch 'irregular-point
                              (corrections-of (mapcar #'(lambda (r) (float-of (/ r scale))) residuals)
                                              (converted-point point #'float-of)))))))
    (if (car found) (mapped-corrections #'(lambda (column value) (* scale (rational value))) (car found)))))

(defun float-of (number) (float number 1d0))

;; In floating point a residual whose terms all vanish, as y where y = 0, may stay: a caller with a point that no
;; correction changes any more continues from there with more digits.
(defun newton-iteration (point &optional damped)
  (let ((last-size nil) (bound nil))
    (dotimes (attempt *most-corrections* nil)
      (let ((residuals (residuals-at point)))
        (if (all-of-p #'zerop residuals) (return (copied-point point)))
        (let* ((corrections (corrections-of residuals point)) (size (largest-correction corrections)))
          (if (and *floating* (< size (* *close* (largest-coordinate point)))) (return point))
          (if (null bound) (setq bound (* *runaway* (max size (largest-coordinate point)))))
          (if (or (> size bound) (and (> attempt *impatience*) last-size (>= size last-size))) (return nil))
          (setq last-size size
                point (if damped
                          (point-of-line-search point corrections size)
                          (corrected-point point corrections)))
          (if (null point) (return nil)))))))

(defun iterated-from (point) (catch 'irregular-point (newton-iteration point)))

(defun point-of-line-search (point corrections size)
  "A point along the corrections, of this size, where the next with the same matrix are shorter; nil where none is."
  (do ((share 1 (/ share 2)) (halvings 0 (1+ halvings)))
      ((> halvings *most-halvings*) nil)
    (let* ((trial (corrected-point point (shortened corrections share)))
           (residuals (catch 'irregular-point (residuals-at trial))))
      (if (and residuals
               (or (all-of-p #'zerop residuals)
                   (< size (* *small-correction* (largest-coordinate point)))
                   (<= (largest-correction (corrections-of residuals point)) (* (- 1 (/ share 4)) size))))
          (return trial)))))

(defun shortened (corrections share) (mapped-corrections #'(lambda (column value) (* share value)) corrections))

(defun mapped-corrections (function corrections)
  (let ((result (make-hash-table)))
    (maphash #'(lambda (column value) (setf (gethash column result) (funcall function column value))) corrections)
    result))

(defun corrections-of (residuals point)
  "Newton's changes of the unknowns, column -> number."
  (if *metric* (corrections-in-metric residuals point) (shortest-corrections residuals point)))

(defun shortest-corrections (residuals point)
  "J^T x with J J^T x = -f."
  (let* ((rows (numeric-rows *jacobian* point))
         (columns (columns-of rows))
         (multiples (solution-of (mapcar #'(lambda (residual row) (with-right-side residual (gram-row row columns)))
                                         residuals rows)))
         (corrections (make-hash-table))
         (beta 0))
    (dolist (row rows corrections)
      (let ((x (gethash (incf beta) multiples 0)))
        (dolist (e row) (incf (gethash (car e) corrections 0) (* x (cdr e))))))))

(defun numeric-rows (rows point) (mapcar #'(lambda (row) (row-at-point row point)) (cdr rows)))

(defun solution-of (rows)
  "Values of the columns; column 0 is the negative of the right-hand side."
  (let ((values (make-hash-table)))
    (setf (gethash 0 values) 1)
    (substituted-back (sparse-echelon rows) values)))

(defun corrections-in-metric (residuals point)
  "The change x that is shortest in the metric A: A x + J^T y = 0, J x = -f."
  (let* ((rows (numeric-rows *jacobian* point))
         (size (length *unknowns*))
         (columns (columns-of rows))
         (s 0)
         (solution (solution-of
                    (append (mapcar #'(lambda (row) (append row (multiplier-entries (gethash (incf s) columns) size)))
                                    (numeric-rows *metric* point))
                            (mapcar #'with-right-side residuals rows))))
         (corrections (make-hash-table)))
    (dotimes (s size corrections) (setf (gethash (1+ s) corrections) (gethash (1+ s) solution 0)))))

(defun multiplier-entries (column size)
  (mapcar #'(lambda (e) (cons (+ size (car e)) (cdr e))) (sort (copy-list column) #'< :key #'car)))

(defun columns-of (rows)
  "column -> list of (row . number)"
  (let ((columns (make-hash-table)) (beta 0))
    (dolist (row rows columns)
      (incf beta)
      (dolist (e row) (push (cons beta (cdr e)) (gethash (car e) columns))))))

(defun gram-row (row columns)
  "The row of J J^T that a row of J gives, in the order of its columns."
  (let ((products (make-hash-table :size 16)) (entries nil))
    (dolist (e row)
      (dolist (other (gethash (car e) columns))
        (push (* (cdr e) (cdr other)) (gethash (car other) products))))
    (maphash #'(lambda (beta numbers)
                 (let ((value (sum-of-numbers numbers)))
                   (if (not (zerop value)) (push (cons beta value) entries))))
             products)
    (sort entries #'< :key #'car)))

(defun with-right-side (residual row) (if (zerop residual) row (acons 0 residual row)))
(defun coordinate (symbol point) (gethash symbol (sample-point-symbols point)))
(defun largest-coordinate (point) (largest-of (mapcar #'(lambda (q) (abs (coordinate q point))) *unknowns*)))

(defun largest-correction (corrections)
  (let ((largest 0))
    (maphash #'(lambda (column value) (declare (ignore column)) (setq largest (max largest (abs value))))
             corrections)
    largest))

(defun corrected-point (point corrections)
  (let ((corrected (copied-point point)) (column 0))
    (dolist (q *unknowns* corrected)
      (setf (gethash q (sample-point-symbols corrected))
            (landed (short-number (+ (coordinate q point) (gethash (incf column) corrections 0))))))))

;; A coordinate that gets so small is on its way to zero: the points are drawn nowhere near it.
(defun landed (coordinate) (if (< (abs coordinate) *small-coordinate*) 0 coordinate))

(defvar *least-share-moved* (expt 10 -12) "Of the largest of several values: the others are rounding errors of zeros.")

(defun $moved_point (point shares)
  "The point, each  name = share  moved by this share of its value; of the least of these values where it is zero."
  (let* ((moved (copied-point point))
         (values (mapcar #'(lambda (share) (abs (coordinate (second share) point))) (cdr shares)))
         (zero (* *least-share-moved* (largest-of (cons 0 values))))
         (sizes (remove-if #'(lambda (value) (<= value zero)) values))
         (least (if sizes (reduce #'min sizes) 1)))
    (mapc #'(lambda (share value)
              (incf (gethash (second share) (sample-point-symbols moved))
                    (* (rational-of (third share)) (if (> value zero) value least))))
          (cdr shares) values)
    moved))

(defun $shifted_point (point shifts)
  "The point, each  name = shift  moved by this."
  (point-with point shifts #'(lambda (old shift) (+ old shift))))

(defun $point_at (point equations)
  "The point with  name = rational number."
  (point-with point equations #'(lambda (old new) (declare (ignore old)) new)))

(defun point-with (point equations combine)
  (let ((moved (copied-point point)))
    (dolist (e (cdr equations) moved)
      (let ((symbols (sample-point-symbols moved)))
        (setf (gethash (second e) symbols)
              (funcall combine (gethash (second e) symbols) (rational-of (third e))))))))

(defun copied-point (point) (converted-point point #'identity))

(defun converted-point (point conversion)
  "The point, its numbers converted, and nothing else known of it."
  (let ((copy (make-sample-point)))
    (maphash #'(lambda (symbol value)
                 (setf (gethash symbol (sample-point-symbols copy)) (funcall conversion value)))
             (sample-point-symbols point))
    copy))

;;; ---- an initial state --------------------------------------------------------------------

(defvar *point-digits* 60)

(defun $values_near (point constraints jacobian metric names digits)
  "Values of the names to a number of digits, near those of the point in the metric, that make the constraints
vanish; false where Newton's method does not get there."
  (let* ((*point-digits* digits)
         (*digits-at-point* (+ digits 20))
         (*zero-share* (expt 10 (- 5 digits)))
         (*small-coordinate* *zero-share*)
         (*equations* (cdr constraints)) (*jacobian* jacobian) (*unknowns* (cdr names)) (*metric* metric)
         (root (catch 'irregular-point (or (root-of-independent-equations point) (root-near point)))))
    (if root
        (cons '(mlist) (mapcar #'(lambda (x) (maxima-number (plain-number (coordinate x root)))) *unknowns*)))))

(defun root-of-independent-equations (point)
  "Where gradients are dependent at a root, those of redundant equations, that root; nil where there is none."
  (let* ((rows (numeric-rows *jacobian* (let ((*close* *close-to-root*)) (or (point-near-manifold point t) point))))
         (numbers (let ((*zero-share* *share-of-dependence*)) (independent-rows-of rows)))
         (root (if (< (length numbers) (length *equations*))
                   (let ((*equations* (items-of-numbers numbers *equations*))
                         (*jacobian* (mlist-of (items-of-numbers numbers (cdr *jacobian*)))))
                     (catch 'irregular-point (root-near point))))))
    (if (and root (all-of-p #'zerop (residuals-at root))) root)))

(defun items-of-numbers (numbers items) (mapcar #'(lambda (i) (nth (1- i) items)) numbers))

(defun root-near (point)
  (let ((found (or (newton-iteration point t) (root-from-around point) (newton-iteration point))))
    (if found (nearer-root found point))))

(defun nearer-root (found point)
  "The root nearest to the point, of those that Newton's method gets to from around it; found, if it is none of them."
  (let ((close (if (and (<= (length *unknowns*) *most-unknowns-searched*) (not (contracts-at-once point)))
                   (nearest-within nil found point))))
    (or (if close (iterated-from close)) found)))

(defun root-from-around (point)
  "The nearest root that Newton's method gets to from around the point, where it gets to none from there; or nil."
  (if (<= (length *unknowns*) *most-unknowns-searched*)
      (some #'(lambda (share)
                (let ((close (nearest-within share nil point))) (if close (iterated-from close))))
            '(1/4 1 4 16))))

(defun contracts-at-once (point)
  "Whether the constraints are nearly linear along the first correction, so that the point is next to its root."
  (let ((corrections (corrections-of (residuals-at point) point)))
    (every #'(lambda (share)
               (let* ((next (corrected-point point (shortened corrections share)))
                      (residuals (catch 'irregular-point (residuals-at next))))
                 (and residuals
                      (<= (largest-difference (corrections-of residuals point) (shortened corrections (- 1 share)))
                          (* *contraction* (largest-correction corrections))))))
           '(1/3 5/7 1))))

(defun largest-difference (corrections others)
  (largest-correction (mapped-corrections #'(lambda (column value) (- value (gethash column others 0))) corrections)))

(defun nearest-within (share found point)
  "The nearest root from starts within this share of the point's size, or the distance of the one found; or nil."
  (let* ((*floating* t)
         (*zero-share* *zero-share-of-floats*)
         (*most-corrections* *most-corrections-of-search*)
         (*most-halvings* *most-halvings-of-search*)
         (guess (converted-point point #'float-of))
         (rows (catch 'irregular-point (numeric-rows *metric* (converted-point point #'float-of))))
         (known (if found (distance-in-metric (converted-point found #'float-of) guess rows)))
         (best nil))
    (do* ((reach (or known (* share (size-in-metric guess rows))) (second best))
          (nearer (nearest-of-starts guess reach known rows) (nearest-of-starts guess reach reach rows)))
         ((null nearer) (if best (point-with-unknowns-of (first best) point)))
      (setq best nearer))))

(defun nearest-of-starts (guess reach known rows)
  "Of the roots from starts at this distance the nearest, with its distance; nil where none is nearer than KNOWN."
  (let ((share (if (< (length *equations*) (length *unknowns*)) *nearer* (- 1 1/1000000))) (best nil))
    (if (plusp reach)
        (dolist (start (starts-around guess reach rows) best)
          (let* ((root (car (errset (catch 'irregular-point (newton-iteration start t)))))
                 (way (if root (distance-in-metric root guess rows))))
            (if (and way (or (null known) (< way (* share known))))
                (setq known way best (list root way))))))))

(defun starts-around (guess distance rows)
  "Points at shares of a distance from the guess, along each of the names."
  (let ((column 0) (starts nil))
    (dolist (name *unknowns* (nreverse starts))
      (incf column)
      (let ((mass (or (cdr (assoc column (nth (1- column) rows))) 0)))
        (if (plusp mass)
            (dolist (share (if (cdr *unknowns*) *starts-around* *starts-on-a-line*))
              (let ((start (copied-point guess)))
                (incf (gethash name (sample-point-symbols start)) (* share (/ distance (sqrt mass))))
                (push start starts))))))))

(defun size-in-metric (guess rows)
  "Its distance from zero; the length of the first correction where it is zero, and 1 where that has none."
  (let ((size (length-in-metric (mapcar #'(lambda (x) (coordinate x guess)) *unknowns*) rows)))
    (if (zerop size) (setq size (length-in-metric (first-ways guess) rows)))
    (if (zerop size) 1d0 size)))

(defun first-ways (guess)
  (let ((corrections (car (errset (catch 'irregular-point (corrections-of (residuals-at guess) guess))))) (column 0))
    (mapcar #'(lambda (x) (declare (ignore x)) (if corrections (gethash (incf column) corrections 0) 0)) *unknowns*)))

(defun distance-in-metric (point guess rows)
  (length-in-metric (mapcar #'(lambda (x) (- (coordinate x point) (coordinate x guess))) *unknowns*) rows))

(defun length-in-metric (ways rows)
  (let ((square 0))
    (mapc #'(lambda (row way) (dolist (e row) (incf square (* way (cdr e) (nth (1- (car e)) ways))))) rows ways)
    (sqrt (float-of (max square 0)))))

(defun plain-number (number)
  "The fraction of few digits that the number agrees with; else its decimal digits."
  (or (simple-fraction number)
      (let ((unit (expt 10 (- *point-digits* (floor (* (log 2d0 10d0) (binary-magnitude number)))))))
        (/ (round (* number unit)) unit))))

(defun simple-fraction (number)
  "The first convergent of the continued fraction that is as near as those digits show."
  (let ((rest (abs number)) (p 1) (p-before 0) (q 0) (q-before 1) (size (abs number)))
    (do () ((> q (expt 10 (floor *point-digits* 4))))
      (let ((whole (floor rest)))
        (psetq p (+ (* whole p) p-before) p-before p q (+ (* whole q) q-before) q-before q)
        (if (<= (abs (- size (/ p q))) (* size (expt 10 (- 10 *point-digits*))))
            (return (* (signum number) (/ p q))))
        (if (= rest whole) (return nil))
        (setq rest (/ 1 (- rest whole)))))))
