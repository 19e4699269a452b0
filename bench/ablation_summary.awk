# Summary of tables of bench_ablation.sh: per variant and scene, then for all scenes, the geometric mean of the error
# over that of the baseline, by the blocks' error and by both relMSE, and how uncertain the first is.
#
# The mean of the logarithms over a variant's seeds is compared with that over all of the baseline's. Their standard
# error comes from the variance between seeds of one variant, pooled over all variants of the scene that have several:
# (sum of squares / degrees of freedom) (1 / seeds + 1 / baseline's seeds). "within a factor of": two standard errors.
BEGIN { FS = OFS = "\t"; print "variant", "scene", "seeds", "trimmed", "within a factor of", "all pixels", "blocks" }
FNR == 1 || $3 == "seed" { summary = 0 }
$3 == "seeds" { summary = 1 } # of an earlier table
/^#/ || $1 == "variant" || NF < 6 || summary { next }
{
    if (!($1 in variant)) { variant[$1] = 1; order[++variants] = $1 }
    if (!($2 in known)) { known[$2] = 1; scene[++scenes] = $2 }
    n = ++count[$1, $2]
    for (k = 1; k <= 3; ++k) sum[$1, $2, k] += log($(k + 3))
    square[$1, $2] += log($4) ^ 2
}
function mean(v, s, k) { return sum[v, s, k] / count[v, s] }
function row(name, where, seeds, a, error, b, c) {
    printf "%s\t%s\t%d\t%.3f\t%.3f\t%.3f\t%.3f\n", name, where, seeds, exp(a), exp(2 * error), exp(b), exp(c)
}
END {
    for (i = 1; i <= scenes; ++i) {
        for (j = 1; j <= variants; ++j) {
            n = count[order[j], scene[i]]
            if (n > 1) {
                squares[i] += square[order[j], scene[i]] - n * mean(order[j], scene[i], 1) ^ 2
                freedom[i] += n - 1
            }
        }
        variance[i] = freedom[i] > 0 ? squares[i] / freedom[i] : 0
    }
    for (j = 1; j <= variants; ++j) {
        v = order[j]
        all = total = 0
        for (k = 1; k <= 3; ++k) whole[k] = 0
        for (i = 1; i <= scenes; ++i) {
            s = scene[i]
            if (!count[v, s]) continue
            for (k = 1; k <= 3; ++k) { log_ratio[k] = mean(v, s, k) - mean("baseline", s, k); whole[k] += log_ratio[k] }
            e = v == "baseline" ? variance[i] / count[v, s] : variance[i] * (1 / count[v, s] + 1 / count["baseline", s])
            total += e
            ++all
            row(v, s, count[v, s], log_ratio[1], sqrt(e), log_ratio[2], log_ratio[3])
            n = count[v, s]
        }
        row(v, "all", n, whole[1] / all, sqrt(total) / all, whole[2] / all, whole[3] / all)
    }
}
