/* Of the polynomials {t_k, c_0, c_1, c_2, c_3} of a table, in order, the last that begins no later than t. */
static const double *piece_at(double t, const double (*pieces)[5], size_t count)
{
    size_t first = 0;
    while (count > 1) {
        size_t half = count/2;
        if (pieces[first + half][0] <= t) first += half, count -= half;
        else count = half;
    }
    return pieces[first];
}

