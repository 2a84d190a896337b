# SPDX-License-Identifier: MIT
# Prints the table of `sh bench/run.sh c_side` from what several programs wrote: their medians, line by line.

# The value in the middle of several, which `values` has with a space before each; sets least and greatest, too.
function median_of(values,    sorted, count, i, k, value) {
    count = split(values, sorted, " ")
    for (i = 2; i <= count; ++i) {
        value = sorted[i] + 0
        for (k = i - 1; k > 0 && sorted[k] + 0 > value; --k) sorted[k + 1] = sorted[k]
        sorted[k + 1] = value
    }
    least = sorted[1]
    greatest = sorted[count]
    return sorted[int((count + 1) / 2)]
}

{
    key = $1 " | " $2 " | " $3
    if (!(key in ratios)) keys[++lines] = key
    times[key] = times[key] " " $4
    ratios[key] = ratios[key] " " $5
}

END {
    print "| options | lights | of | C++ us a build | C / C++ | least | greatest |"
    print "| --- | --- | --- | --- | --- | --- | --- |"
    for (line = 1; line <= lines; ++line) {
        key = keys[line]
        time = median_of(times[key])
        ratio = median_of(ratios[key])
        printf "| %s | %.1f | %.3f | %.3f | %.3f |\n", key, time, ratio, least, greatest
        all = all " " ratio
        if (ratio > 1.03) ++above
    }
    ratio = median_of(all)
    printf "C over C++: %.3f to %.3f, median %.3f; ", least, greatest, ratio
    printf "%d of %d lines are above 1.03\n", above, lines
}
