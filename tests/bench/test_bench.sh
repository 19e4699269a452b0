#!/bin/sh
# End-to-end tests of `twinlight bench`: a tiny report whose figures are recomputed from its images, resuming after an
# earlier call, and signals. And the list of variants for bench_ablation.sh. Runs in the build folder; srcdir is the
# source folder (both set by `make check`).
set -u

# shellcheck source=tests/support/cli.sh
. "${srcdir:-.}/tests/support/cli.sh"

expect 2 'no scene is given' bench
expect 2 'does not end in .html' bench -o report.txt "$scene"
expect 2 'is not longer than the time before it' bench --times=2s,1s "$scene"
expect 2 'pt is named twice' bench --integrators=pt,bdpt,pt "$scene"
expect 2 '--patch=wall:1,2,3: not a patch' bench --patch=wall:1,2,3 "$scene"
expect 2 'another patch has the same name' bench --patch=a:1,2,3,4 --patch=a:5,6,7,8 "$scene"
expect 2 '2 references for 1 scenes' bench --reference=a.exr --reference=b.exr "$scene"
expect 2 '--runs=0: out of range' bench --runs=0 "$scene"
expect 1 'nowhere/report.html' bench -o nowhere/report.html "$scene"
expect 1 'missing.pbrt' bench --times=9s "$scene" missing.pbrt
expect 1 'missing.exr' bench --times=9s --reference=missing.exr "$scene"
expect 1 'the patch wall reaches beyond the film' bench --resolution=32x24 --patch=wall:20,0,13,4 "$scene"

# Every variant of bench/ablation.txt changes the file that it names: it would be measured against itself otherwise.
sources=${scene%/scenes/*}
while IFS="$(printf '\t')" read -r variant file expression; do
    case $variant in '' | '#'*) continue ;; esac
    [ "$file" != + ] || continue
    ! sed "$expression" "$sources/$file" | cmp -s - "$sources/$file"
    result "bench/ablation.txt: $variant changes nothing in $file" $?
done <"$sources/bench/ablation.txt"

# tiny ARGUMENT...: a report of two integrators at two times.
tiny() {
    "$program" bench --integrators=pt,mmlt --times=0.1s,0.2s --reference-time=0.4s --resolution=32x24 --max-depth=4 \
        --threads=2 --patch='wall & "door":4,2,12,8' -o tiny.html "$@" "$scene" >out 2>err
}

tiny --runs=2
result 'bench: exit status' $?
for file in tiny.html tiny.tsv tiny.json; do
    file_exists $file
done
[ "$(wc -l <tiny.tsv)" -eq 9 ]
result 'tiny.tsv has not a line for each of 8 runs' $?
grep -q '10 of 10' err
result 'progress does not count all 10 renderings' $?
# The page references only its own elements, embedded data and XML namespaces.
! grep -oE '(src|href)="[^"]{0,12}' tiny.html | grep -vE '"(#|data:image)' | grep -q .
result 'the page refers to something outside of it' $?
! grep -q '<script' tiny.html
result 'the page has a script' $?

if command -v python3 >/dev/null 2>&1; then
    PROGRAM=$program python3 - >out 2>err <<'PYTHON'
import csv, json, math, os, statistics, subprocess
import xml.etree.ElementTree as xml

page = xml.parse("tiny.html").getroot()
text = "".join(page.itertext())
assert 'wall & "door"' in text
assert sum(e.tag.endswith("}image") for e in page.iter()) == 1 + 3 * 2, "reference, and picture, error and FLIP of each"
ids = [e.get("id") for e in page.iter() if e.get("id")]
assert len(ids) == len(set(ids))
assert all(e.get("href")[1:] in ids for e in page.iter() if e.get("href", "").startswith("#"))

rows = list(csv.DictReader(open("tiny.tsv"), delimiter="\t", quoting=csv.QUOTE_NONE))
for row in rows:
    shown = subprocess.run([os.environ["PROGRAM"], "compare", "--json", row["image"], row["reference"]],
                           capture_output=True, check=True).stdout
    again = json.loads(shown)
    for key in ("rel_mse", "rel_mse_trimmed", "mape", "flip", "ssim"):
        assert math.isclose(float(row[key]), again[key], rel_tol=1e-7), (key, row[key], again[key])
    assert math.isclose(float(row["mean_ratio"]), again["mean"] / again["mean_reference"], rel_tol=1e-6)
assert len({row["seed"] for row in rows}) == 8, "every run has a seed of its own"

def quantile(values, q):
    values, place = sorted(values), q * (len(values) - 1)
    below = int(place)
    return values[below] + (place - below) * (values[min(below + 1, len(values) - 1)] - values[below])

def of(integrator, time, key):
    return [float(r[key]) for r in rows if r["integrator"] == integrator and float(r["time"]) == time]

report = json.load(open("tiny.json"))
series = {s["integrator"]: s for s in report["scenes"][0]["series"]}
for name, s in series.items():
    for group in s["groups"]:
        assert group["runs"] == 2
        for key in ("seconds", "rel_mse", "flip"):
            wanted = [quantile(of(name, group["time"], key), q) for q in (0.1, 0.5, 0.9)]
            assert all(math.isclose(a, b, rel_tol=1e-6) for a, b in zip(group[key], wanted)), (key, group[key], wanted)
        assert math.isclose(group["efficiency"], 1 / (group["variance"] * group["seconds"][1]), rel_tol=1e-6)
    x, y = ([math.log10(float(r[k])) for r in rows if r["integrator"] == name] for k in ("seconds", "rel_mse"))
    mx, my = statistics.mean(x), statistics.mean(y)
    slope = sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)
    assert math.isclose(s["by_time"]["slope"], slope, rel_tol=1e-5, abs_tol=1e-6), (s["by_time"], slope)
    assert math.isclose(s["speedup"], series["pt"]["equal_seconds"] / s["equal_seconds"], rel_tol=1e-6)
    # The page's table shows the median of the longest time to three digits.
    median = s["groups"][-1]["rel_mse"][1]
    exponent = math.floor(math.log10(median))
    digits = "%.*f" % (2 - exponent, median) if exponent > -4 else "%.2f\u00d710" % (median / 10 ** exponent)
    assert digits in text, digits
scene = report["scenes"][0]
assert 0 < scene["reference_rel_mse"] < 10
assert scene["reference_origin"].startswith("rendered here: bdpt") and "among" not in scene["reference_origin"]
assert any(r.get("chains", {}).get("mutations", 0) > 0 for r in scene["runs"])
PYTHON
    result 'the report is not well-formed, or has figures that are not those of its images' $?
fi

# Repeating the command renders nothing; one more run renders only the new ones.
find tiny.runs -name '*.record' | sort >before
touch mark
tiny --runs=2
[ -z "$(find tiny.runs -name '*.record' -newer mark)" ]
result 'what was finished is rendered again' $?
tiny --runs=3
[ "$(find tiny.runs -name '*.record' -newer mark | wc -l)" -eq 4 ]
result 'a third run is not four renderings more' $?
record=$(head -n 1 before)
head -c 200 "$record" >short
mv short "$record"
touch mark
tiny --runs=3
[ "$(find tiny.runs -name '*.record' -newer mark | wc -l)" -eq 1 ]
result 'a record that was cut off is taken for whole' $?

# A given reference, and a signal: what is finished is reported.
reference=$(find tiny.runs -name '*-mean.exr')
$with_signals "$program" bench --quiet --integrators=pt,bdpt --times=0.1s,60s --runs=1 --resolution=32x24 --max-depth=4 \
    --reference="$reference" -o ended.html "$scene" >out 2>err &
process=$!
tries=0
while [ "$(find ended.runs -name '*.record' 2>/dev/null | wc -l)" -lt 2 ] && [ "$tries" -lt 600 ]; do
    sleep 0.1
    tries=$((tries + 1))
done
kill -s INT $process
wait $process
[ $? -eq 130 ]
result 'SIGINT: exit status is not 130' $?
grep -q 'Not finished: 2 of 4 renderings' ended.html
result 'SIGINT: the report does not say what is missing' $?
[ "$(wc -l <ended.tsv)" -eq 3 ]
result 'SIGINT: the table has not both runs' $?

"$program" render --quiet --integrator=pt --resolution=16x12 --samples=1 -o other.exr "$scene"
expect 1 'the sizes differ' bench --integrators=pt --times=60s --runs=1 --resolution=32x24 --reference=other.exr \
    -o sizes.html "$scene"

checks_end
