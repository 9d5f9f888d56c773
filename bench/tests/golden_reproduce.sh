#!/usr/bin/env bash
# A golden run of `sipplab reproduce`: a few cells, generated and from an archive, taken up again,
# judged later, and as a page. Prints one line per promise that is broken.
#
#   golden_reproduce.sh PATH_OF_SIPPLAB
. "$(dirname "${BASH_SOURCE[0]}")/golden_support.sh"
ask() { sqlite3 sipplab.db "$1"; }

# 0 or 1: so few instances may differ from the paper's. On a machine with other work the ten
# seconds of --quick would decide: the paper's five minutes instead.
verdict() {
  "$sipplab" reproduce aamas2018 "$@" >out 2>err
  local code=$?
  [ "$code" -le 1 ] || complain "exit code $code: reproduce $* ($(head -c 300 err))"
}

verdict --quick --count 2 --robots 32 --repeats 1 --time-limit 300 -o page
says '^Figure 1: share solved'
says '^32 +1\.00 +1\.00 +1\.00 +1\.00 +1\.00 *$'
says '^32 +deterministic +2 +1\.000 \[0\.342, 1\.000\] \(1\.00\) reproduced'
says '^16 +deterministic +0 +not measured'
says '^fig1-a +not measured'
equal "$(ask "SELECT suite, count(*) FROM v_results GROUP BY suite")" \
  'paper-quick|16' 'what was planned'
grep -q '<svg' page/index.html || complain 'no figure on the page'
grep -q '<svg' page/figure1.svg || complain 'no figure1.svg'
grep -q '<svg' page/table1.svg || complain 'no table1.svg'
cp out first
planned=$(ask "SELECT run FROM v_runs")
verdict --run latest
cmp -s out first || complain 'judged later, the run says something else'
verdict --run latest --json
says '"reproduced": '
says '"success_interval": '
equal "$(grep -c '"holds": null' out)" 10 'claims in JSON'
verdict --quick --count 2 --robots 32 --repeats 1 --time-limit 300 --resume
says 'plannings are there' err
cmp -s out first || complain 'resumed when finished, the run says something else'

# The pictures alone, from the history.
expect 0 plot figure1 -o figure1.svg
cmp -s figure1.svg page/figure1.svg || complain 'plot figure1 draws another picture than the page'
says 'run [0-9a-f]{8} \(paper-quick.*n = 2 results a point' figure1.svg
expect 0 plot table1 "$planned" -o table1.svg
cmp -s table1.svg page/table1.svg || complain 'plot table1 draws another picture than the page'
expect 0 plot figure1
says '<svg'
expect 0 plot success latest -o success.pdf
equal "$(head -c 5 success.pdf)" '%PDF-' 'a picture as PDF'
for picture in runtime cactus box-runtime box-flowtime box-makespan; do
  expect 0 plot "$picture" --run latest --run "$planned" --case environment=warehouse -o picture.svg
  says '</svg>' picture.svg
  says 'runs? [0-9a-f]{8} ' picture.svg
done
refused 'picture.png.*expected a name that ends in .svg or .pdf' plot success -o picture.png
refused "'pie'|pie" plot pie
refused 'expected two of them, and a scatter plot' plot success --side ssi=0
expect 4 plot scatter latest --case ssi=5,reschedule=random,order=shortest,environment=warehouse
says 'expected two runs, or --side twice' err
expect 0 plot scatter-flowtime latest --side reschedule=deterministic --side reschedule=random -o picture.svg
says 'reschedule=random' picture.svg
expect 4 plot improvement
runs 2 env PATH=/nowhere "$sipplab" plot success -o absent.svg
equal "$(wc -l <err)" 1 'lines without gnuplot'
says 'no program gnuplot here.*gnuplot-nox' err
[ ! -e absent.svg ] || complain 'a picture without gnuplot'
expect 0 plot runtime latest --case environment=warehouse --case reschedule=deterministic
says '<svg'
says 'warehouse, .*deterministic'
refused 'expected no --case' plot figure1 --case robots=32
refused 'expected values of columns such as robots=64' plot runtime --case 7
refused 'shows one run' plot figure1 latest latest
expect 4 plot runtime --case robots=33
says 'nothing to draw' err

# The archive's files: a folder for each map and number of robots; what it lacks is left out.
mkdir -p archive/warehouse archive/empty/64
expect 0 generate --map warehouse --agents 32 --count 3 --seed 3 -o archive/warehouse/32
verdict --quick --instances archive --count 2 --repeats 1 --time-limit 300
says '^32 +random +2 '
equal "$(ask "SELECT count(*), count(DISTINCT environment) FROM v_results WHERE instance_set LIKE '%archive%'")" '6|1' \
  'instances of the archive'

refused "expected I/N" reproduce aamas2018 --shard 3
refused "nowhere" reproduce aamas2018 --instances nowhere
expect 0 bench --suite smoke --robots 8 --map empty:9x9 --count 1
expect 4 plot figure1
expect 0 bench --suite smoke --robots 8 --map warehouse --count 1 --connectedness 2,4
refused 'expected one planner' plot table1
expect 0 plot runtime latest --case connectedness=2
says '<svg'

[ "$broken" -eq 0 ] && echo "reproduce: everything as promised"
exit "$((broken > 0))"
