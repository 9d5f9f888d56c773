#!/usr/bin/env bash
# A golden run of the command line: what a user does, what a user gets wrong, and what
# the machine does to a sweep. Prints one line per promise that is broken.
#
#   golden_cli.sh PATH_OF_SIPPLAB
. "$(dirname "${BASH_SOURCE[0]}")/golden_support.sh"
# A copy, so that another user may run it for the test of permissions.
install -m 755 "$sipplab" sipplab
chmod 755 .
sipplab=$work/sipplab

ask() { sqlite3 history.db "$1"; }

# --- what a user does -------------------------------------------------------------

expect 0 generate --map warehouse --agents 16 --count 11 --seed 7 -o warehouse
equal "$(find warehouse -type f | wc -l)" 11 "generated files"
expect 0 generate --map warehouse --agents 16 --count 2 --seed 7 -o again
cmp -s warehouse/1.xml again/1.xml || complain "instance 1 depends on the count"
expect 0 generate --map random:12x9:0.2 --agents 3 --seed 3 --format movingai -o movingai --json
says '"files"'

expect 0 plan --instance warehouse/0.xml
says 'solved, valid'
for format in xml json csv; do
  expect 0 plan --instance warehouse/0.xml --ssi 2.5 -o "plan.$format" --svg plan.svg
  expect 0 validate --instance warehouse/0.xml --solution "plan.$format"
  says '^valid'
done
says '</svg>' plan.svg
says '"ssi": 2.5' plan.json
expect 0 validate --instance warehouse/0.xml --solution plan.json --certify
says '^certified: 120 pairs safe, 0 in collision, 0 undecided'
expect 1 validate --instance warehouse/1.xml --solution plan.json --certify --json
says '"certified"'
expect 0 validate --instance warehouse/0.xml --solution plan.json --ssi 2.5 --json
says '"valid": true'
says '"ssi_checked": "2.5"'
expect 1 validate --instance warehouse/1.xml --solution plan.json
says 'invalid'
expect 0 plan --instance movingai/0.scen --connectedness 5 --no-any-angle --json
says '"status": "solved"'
expect 0 plan --instance warehouse/0.xml --weight 1.25 --json
says '"weight": 1.25'
expect 0 plan --map movingai/0.map --task movingai/0.scen --format csv
says '^agent,id,t0,t1,x0,y0,x1,y1'

# The same plan twice.
expect 0 plan --instance warehouse/3.xml --json
hash=$(grep plan_hash out)
expect 0 plan --instance warehouse/3.xml --json
equal "$(grep plan_hash out)" "$hash" "the plan, planned again"

# Nobody to plan for.
printf '<root><agents number="0"/><map><grid width="2" height="1"><row>0 0</row></grid></map></root>' >nobody.xml
expect 0 plan --instance nobody.xml --json
says '"status": "solved"'
says '"makespan": 0,'

# Two robots that swap places in a corridor: no plan, and that is an answer.
printf '<root><agents number="2"><agent start.x="0" start.y="0" goal.x="3" goal.y="0"/><agent start.x="3" start.y="0" goal.x="0" goal.y="0"/></agents><map><grid width="4" height="1"><row>0 0 0 0</row></grid></map></root>' >swap.xml
expect 1 plan --instance swap.xml --json
says '"status": "failed"'
says '"valid": false'
expect 1 plan --instance swap.xml --max-expansions 1 --json
says '"status": "limit"'

# Robots that meet in a corridor with one bay: prioritized planning fails, the fallback does not.
printf '<root><agents number="2"><agent start.x="0" start.y="0" goal.x="4" goal.y="0"/><agent start.x="4" start.y="0" goal.x="0" goal.y="0"/></agents><map><grid width="5" height="2"><row>0 0 0 0 0</row><row>1 1 0 1 1</row></grid></map></root>' >bay.xml
expect 1 plan --instance bay.xml --reschedule none --no-any-angle
for format in xml json; do
  expect 0 plan --instance bay.xml --reschedule none --no-any-angle --fallback complete -o "bay.$format.out" --format "$format"
  says '^made by     LaCAM'
  expect 0 validate --instance bay.xml --solution "bay.$format.out"
  says '^valid.*start-safe interval [0-9.]+ kept'
done
says '"made_by": "complete"' bay.json.out
# The fallback comes last: after longer start-safe intervals, and where a limit struck before them.
expect 0 plan --instance bay.xml --reschedule none --ssi 1,2 --fallback complete --json
says '"tries": 3,'
expect 0 plan --instance bay.xml --ssi 1,2 --max-restarts 0 --fallback complete
says '^made by     LaCAM'
expect 0 plan --instance bay.xml --method complete --json
says '"tries": 1,'
expect 0 plan --instance warehouse/0.xml --fallback complete --json
says '"made_by": "prioritized"'
expect 1 plan --instance swap.xml --fallback complete
says '^status      failed'
sed 's/<agent /<agent movespeed="2" /' bay.xml >fast.xml
refused 'speed 1, expected the speed of agent 0, 2, for LaCAM' plan --instance fast.xml --fallback complete
refused 'headings, delays or inflation, expected none' plan --instance bay.xml --fallback complete --turns
refused "'greedy', expected none or complete" plan --instance bay.xml --fallback greedy
refused "'greedy', expected prioritized or complete" plan --instance bay.xml --method greedy

# An empty value, as of a variable that is not set, names nothing.
for command in 'bench --suite smoke' 'import google-benchmark r.json' 'merge other.db' 'runs' 'plot figure1'; do
  # shellcheck disable=SC2086 # words of a command
  refused '^sipplab: --db is empty, expected a value; see' $command --db ''
done
refused '--output is empty, expected a value' plan --instance bay.xml -o ''

mkdir mixed && cp fast.xml mixed/0.xml

# --- headings ---------------------------------------------------------------------

# Half a turn, three cells, a quarter turn back.
printf '<root><agents number="1"><agent start.x="0" start.y="0" goal.x="3" goal.y="0" start.heading="180" goal.heading="90"/></agents><map><grid width="4" height="1"><row>0 0 0 0</row></grid></map><algorithm><planforturns>true</planforturns></algorithm></root>' >turn.xml
expect 0 plan --instance turn.xml --json
says '"makespan": 4.5,'
says '"turn_to": 90'
says '"turns": true'
expect 0 plan --instance turn.xml --wait-before-move 0.25 -o turn.json
expect 0 validate --instance turn.xml --solution turn.json
says '^valid: makespan 4.750 s'
expect 0 plan --instance turn.xml --no-turns -o straight.csv
expect 1 validate --instance turn.xml --solution straight.csv
says 'stands for 0 s from time 0 on, turns and delays take 1 s'
expect 0 validate --instance turn.xml --solution straight.csv --no-turns
sed 's/heading="180"/heading="400"/' turn.xml >turn_too_far.xml
refused "turn_too_far.xml:1: start.heading '400'" plan --instance turn_too_far.xml
refused 'inflate-time' plan --instance turn.xml --inflate-time -1
refused 'inflated distances or times, expected none' plan --instance turn.xml --inflate-time 1 --best
expect 0 plan --instance turn.xml --best --improve 5i
expect 0 generate --map empty:16x16 --agents 6 --radius 0.3,1.4 --speed 0.5,2 --headings --obstacles 1 -o bodies
expect 0 plan --instance bodies/0.xml --turns --inflate-distance 0.125 --inflate-time 0.25
expect 0 bench --instances bodies --turns --wait-before-move 0.25 --inflate-time 0.5 --max-restarts 3 --db rules.db
equal "$(sqlite3 rules.db 'SELECT DISTINCT planner FROM v_run_cells')" 'sipplab turns:yes wait-before-move:0.25 inflate-time:0.5' 'the rules in the history'
refused 'inflated distances or times, expected none' bench --instances bodies --inflate-time 1 --improve 5i --db rules.db

# A folder as one finds it: a log beside the instances, a file that is cut off, an instance twice.
mkdir stray && cp warehouse/0.xml warehouse/1.xml stray/ && cp warehouse/1.xml stray/7.xml
"$sipplab" plan --instance warehouse/0.xml --format xml -o stray/0_log.xml >/dev/null
head -c 700 warehouse/2.xml >stray/9.xml
echo '<graphml><graph/></graphml>' >stray/roadmap.xml
expect 0 bench --instances stray --db stray.db
says '^stray/roadmap.xml: XML of another kind, expected' err
rm stray/roadmap.xml
says '^stray/0_log.xml: a solution, expected an instance; left out$' err
says 'stray/7.xml: the same instance as .*stray/1.xml$' err
says '^stray/9.xml:[0-9]+: ' err
equal "$(sqlite3 stray.db "SELECT group_concat(status), sum(message LIKE 'stray/9.xml:%') FROM (SELECT * FROM v_results ORDER BY position)")" \
  'solved,solved,solved,failed|1' 'a broken instance costs its own row'
refused 'stray/0_log.xml: a solution' bench --instances stray --strict --db stray.db
rm stray/0_log.xml
refused 'stray/7.xml: the same instance' bench --instances stray --strict --db stray.db
rm stray/7.xml
refused 'stray/9.xml:[0-9]+: ' bench --instances stray --strict --db stray.db
rm stray/9.xml
expect 0 bench --instances stray --strict --db stray.db
[ ! -s err ] || ! grep -q '^stray/' err || complain "something is said of a clean folder: $(cat err)"

# MovingAI's files state no bodies.
scenario=(--map movingai/0.map --task movingai/0.scen)
expect 0 plan "${scenario[@]}" --radius 0.3 --speed 2 --json
says '"radius": 0.3, "speed": 2,'
cp out small_and_quick.json
expect 0 validate "${scenario[@]}" --radius 0.3 --speed 2 --solution small_and_quick.json
expect 1 validate "${scenario[@]}" --radius 0.3 --solution small_and_quick.json
refused 'warehouse/0.xml:[0-9]+: robots with a radius and speed of their own' plan --instance warehouse/0.xml --radius 0.3
refused 'radius.*-1' plan "${scenario[@]}" --radius -1
expect 0 bench --instances movingai --radius 0.3 --speed 2 --db radius.db
expect 0 bench --suite smoke --map empty:9x9 --robots 2 --count 1 --ssi 0 --reschedule none --order shortest --radius 0.25 --db radius.db
equal "$(sqlite3 radius.db 'SELECT DISTINCT radius_cells, speed_cells_per_s FROM v_cases ORDER BY 1')" $'0.25|1.0\n0.3|2.0' 'bodies in the history'
refused 'several radii' bench --instances movingai --radius 0.3,0.4 --db radius.db
refused '--radius: suite adversarial has instances of its own' bench --suite adversarial --radius 0.3 --db radius.db
refused '--robots: suite adversarial has instances of its own' bench --suite adversarial --robots 8 --db radius.db
refused '--count: suite adversarial has' bench --suite adversarial --count 8 --db radius.db
refused '--map: suite adversarial has maps of its own' bench --suite adversarial --map empty:9x9 --db radius.db
refused '--map: suite scale has maps of its own' bench --suite scale --map empty:9x9 --db radius.db
refused '--robots 300: suite scale has maps for 256, 512' bench --suite scale --robots 256,300 --db radius.db
expect 0 bench --suite scale --robots 512,256 --benchmark_list_tests
equal "$(grep -oE 'empty:[0-9x]+/agents:[0-9]+' out | tr '\n' ' ')" 'empty:64x64/agents:256 empty:91x90/agents:512 ' 'cases of scale'
expect 0 generate --map empty:9x9 --agents 3 --format movingai --radius 0.3 --speed 2 -o small
says 'sipplab bench --instances small --radius 0.3 --speed 2$'

expect 0 bench --instances bodies --weight 1,1.05 --max-restarts 3 --db weights.db
equal "$(sqlite3 weights.db 'SELECT group_concat(weight) FROM (SELECT weight FROM v_cases ORDER BY weight)')" \
  '1.0,1.05' 'the weights in the history'

# --- the history ------------------------------------------------------------------

expect 0 bench --suite smoke --map warehouse --robots 8 --ssi 0,2.5,inf --reschedule deterministic --order shortest --any-angle --connectedness 2 --count 2 --db history.db
says '^warehouse +deterministic +8 +2.5 +2/2 +0 +1.00'
equal "$(ask 'SELECT group_concat(ssi_s) FROM (SELECT ssi_s FROM v_run_cells ORDER BY ssi_s)')" "0.0,2.5,Inf" "start-safe intervals"
equal "$(ask 'SELECT count(*) FROM v_results WHERE valid AND status = '\''solved'\')" 6 "results"
expect 0 bench --instances warehouse --db history.db --count 3 --benchmark_format=json
python3 -c 'import json; json.load(open("out"))' 2>/dev/null || ! command -v python3 >/dev/null || complain "bench's JSON does not parse"
equal "$(ask "SELECT group_concat(instance) FROM (SELECT instance FROM v_results WHERE map_spec = 'files' ORDER BY instance)" | tr -d ' ' | sed 's/[^,]*\///g')" "0.xml,1.xml,2.xml" "instances of a folder"
expect 0 bench --suite smoke --benchmark_list_tests --benchmark_filter=agents:32/.*fifo
equal "$(wc -l <out)" 8 "cases listed"
says '^plan/warehouse/agents:32/ssi:2.5/reschedule:deterministic/order:fifo/iterations'
[ ! -e sipplab.db ] || complain "listing cases made a history"
# Without a time limit, here and elsewhere: on a machine with other work it would decide.
expect 0 bench --suite dense --map warehouse --robots 128 --count 2 --time-limit inf --db dense.db
expect 0 bench --suite smoke --map warehouse --robots 128 --time-limit inf --ssi 0 --reschedule none --order shortest --connectedness 2 --any-angle --count 2 --fallback complete --db dense.db
equal "$("$sipplab" sql --db dense.db --format csv "SELECT planner, made_by, results, solved FROM v_plan_makers ORDER BY planner" | tail -n +2 | tr -d '\r' | tr '\n' ' ')" \
  "sipplab any-angle:no method:complete,complete,2,2 sipplab fallback:complete,complete,2,2 " "who made the plans"
equal "$("$sipplab" sql --db dense.db --format csv "SELECT count(*), min(solved), min(peak_memory_bytes > 0), min(mean_expansions > 0) FROM v_work" | tail -n +2 | tr -d '\r')" \
  "2,2,1,1" "work of each case"
refused 'expected the speed of agent 0' bench --instances mixed --fallback complete --db dense.db
expect 0 runs --db history.db
equal "$(grep -cE 'smoke|instances' out)" 2 "runs listed"
expect 0 show --db history.db --json
says '"cells"'
expect 0 sql --db history.db 'SELECT count(*) AS n FROM v_results' --format csv
says '^9'
export SIPPLAB_DB=history.db
expect 0 sql 'SELECT suite FROM v_runs ORDER BY suite' --json
says '"suite": ?"instances"'
unset SIPPLAB_DB

# --- what a user gets wrong -------------------------------------------------------

dump() { sqlite3 history.db .dump | cksum; }
before=$(dump)

refused 'subcommand'
refused 'no command is called frobnicate' frobnicate
refused 'no such file|nothing.db' runs --exclude latest --reason x --db nothing.db
[ ! -e nothing.db ] || complain "a history was made where a run was to be excluded"
refused 'frobnicate' plan --frobnicate
refused 'ssi' plan --instance warehouse/0.xml --ssi -1
refused 'ssi' plan --instance warehouse/0.xml --ssi nan
refused 'time-limit' plan --instance warehouse/0.xml --time-limit 0
refused 'connectedness' plan --instance warehouse/0.xml --connectedness 6
refused 'weight' plan --instance warehouse/0.xml --weight 0.9
refused 'wait-before-move' plan --instance warehouse/0.xml --wait-before-move nan
refused 'inflate-time' plan --instance warehouse/0.xml --inflate-time nan
refused 'tolerance' gate --tolerance nan
refused 'min-effect' trend success --min-effect nan --db history.db
refused 'seconds' fuzz run --seconds nan
refused 'weight' bench --suite smoke --weight 1,nan --db history.db
refused "ssi: '5,,9', expected something" plan --instance warehouse/0.xml --ssi 5,,9
refused "robots: '8,', expected something" bench --map empty:9x9 --robots=8, --db history.db
refused 'ssi.*1e\+07' plan --instance warehouse/0.xml --ssi 1e8
refused 'agents.*-1' generate --map empty:9x9 --agents -1 -o too_many
refused 'agents' generate --map empty:9x9 --agents 99999999999999999999 -o too_many
refused 'robots' bench --map empty:9x9 --robots -1 --db history.db
refused 'robots' reproduce aamas2018 --robots 18446744073709551615 --db history.db
refused 'max-expansions.*-1' plan --instance warehouse/0.xml --max-expansions -1
refused 'limit.*-1' runs --limit -1 --db history.db
refused 'rows.*-1' trend success --rows -1 --db history.db
refused 'movingai.*radii' generate --map empty:9x9 --agents 1 --format movingai --radius 0.3,0.4 -o too_many
refused 'movingai.*obstacles' generate --map empty:9x9 --agents 1 --format movingai --obstacles 2 -o too_many
refused 'benchmark_out' bench --suite smoke --benchmark_out=nowhere/x.json --db history.db
expect 0 generate --map warehouse --agents 3 --seed 899472 --speed 1000 --obstacles 3 -o quick
"$sipplab" plan --instance quick/0.xml >out 2>err
[ $? -le 1 ] || complain "what generate writes is not read: $(cat err)"
refused 'one of true or false' plan --instance warehouse/0.xml --any-angle=foo
refused 'one of true or false' plan --instance warehouse/0.xml --turns=x
refused 'rounding' bench --map empty:9x9 --robots 1 --planner 'cmd:true {task}' --rounding 1 --db history.db
refused 'planner.*no such file' bench --map empty:9x9 --robots 1 --planner 'cmd:./nowhere {task}' --db history.db

# A file that is read, or the history, is not written over.
cp warehouse/0.xml only_copy.xml
refused '-o.*--instance|output.*--instance' plan --instance only_copy.xml -o ./only_copy.xml
refused 'svg.*--instance' plan --instance only_copy.xml --svg only_copy.xml
refused 'output.*svg|svg.*output' plan --instance only_copy.xml -o both --svg both
expect 0 plan --instance only_copy.xml -o plan_of_copy.xml
refused 'svg.*--solution' validate --instance only_copy.xml --solution plan_of_copy.xml --svg plan_of_copy.xml
cmp -s only_copy.xml warehouse/0.xml || complain "an instance was written over"
cp history.db kept.db
refused 'svg.*--db' trend success --db kept.db --svg kept.db
refused 'output.*--db' plot runtime --db kept.db -o kept.db
refused 'junit.*--db' compare latest latest --db kept.db --junit kept.db
refused 'benchmark_out.*--db' bench --suite smoke --db kept.db --benchmark_out=kept.db
SIPPLAB_DB=kept.db refused 'svg.*the history' trend success --svg kept.db
cmp -s kept.db history.db || complain "a history was written over"
expect 0 plan --instance only_copy.xml -o /dev/null --svg /dev/null
# The name of a picture says its format, or the picture is refused before any planning.
refused 'drawn.pdf: pictures of plans are SVG, expected a name that ends in .svg' plan --instance only_copy.xml --svg drawn.pdf
refused 'drawn: no picture, expected a name that ends in .svg' plan --instance absent.xml --svg drawn
refused 'drawn.png: no picture' validate --instance only_copy.xml --solution plan_of_copy.xml --svg drawn.png
refused 'drawn.pdf: pictures of plans are SVG' property replay --svg drawn.pdf
refused 'drawn.pdf: pictures of plans are SVG' findings show 1 --svg drawn.pdf
if [ -e drawn.pdf ] || [ -e drawn.png ] || [ -e drawn ]; then complain 'a refused picture was written'; fi
expect 0 plan --instance only_copy.xml -o /dev/null --svg /dev/fd/3 3>redirected
says '</svg>' redirected

# Names come from anywhere: no control character of one reaches a terminal.
SIPPLAB_MACHINE=$'odd\e[31m\nname' expect 0 bench --map empty:5x5 --robots 1 --count 1 --ssi 0 --reschedule none --order fifo --db odd.db
for shown in runs show 'trend runtime'; do
  # shellcheck disable=SC2086
  expect 0 $shown --db odd.db
  says 'odd.x1b\[31m.nname' out
done
# What one run repeated and another did not is nothing that the other failed at.
expect 0 bench --map empty:5x5 --robots 1 --count 1 --ssi 0 --reschedule none --order fifo --db odd.db --repetitions 3
expect 0 trend flowtime --db odd.db
says 'over the 1 of 1 plannings that all solved' out

# Names that SQLite has a use of its own for are files.
expect 0 bench --map empty:5x5 --robots 1 --count 1 --ssi 0 --reschedule none --order fifo --db :memory:
says '^.1/1. empty:5x5, 1 robots' err
expect 0 runs --db :memory:
[ -f :memory: ] || complain "a history called :memory: is no file"

refused 'no instance' plan
refused 'missing.xml' plan --instance missing.xml
refused 'robots' generate --map empty:2x2 --agents 5 -o too_many
[ ! -e too_many ] || complain "an impossible wish left a folder"
refused 'map|empty:0x5' generate --map empty:0x5 --agents 1 -o too_many
refused 'map' generate --map random:5x5:nan --agents 1 -o too_many
refused 'suite' bench --suite nonsense --db history.db
refused 'unknown' bench --suite smoke --benchmark_nonsense=1 --db history.db
refused 'format' bench --suite smoke --benchmark_format=xml --db history.db
refused 'no case' bench --suite smoke --benchmark_filter=nonsense --db history.db
refused 'filter' bench --suite smoke '--benchmark_filter=(' --db history.db
refused 'robots|agents' bench --suite smoke --robots 5000 --db history.db
refused 'nowhere' bench --instances nowhere --db history.db
refused 'nowhere.db' runs --db nowhere.db
[ ! -e nowhere.db ] || complain "reading made a history"
refused '' sql --db history.db 'DELETE FROM result'
refused '' sql --db history.db 'SELECT nonsense'
refused '' show --db history.db ffffffff
echo 'not a database, whatever its name says; long enough to be taken for one' >text.db
refused 'text.db' bench --suite smoke --db text.db
equal "$(wc -c <text.db)" 72 "bytes of a file that is no database"

mkdir bad
agents='<agents number="1"><agent start.x="0" start.y="0" goal.x="1" goal.y="0"/></agents>'
grid='<map><grid width="2" height="1"><row>0 0</row></grid></map>'
instance() { printf '<root>%s%s</root>' "$1" "$2" >"bad/$3.xml"; }
head -c 700 warehouse/0.xml >bad/truncated.xml
instance "${agents/number=\"1\"/number=\"3\"}" "$grid" wrong_count
instance "$agents" '<map><grid width="2" height="2"><row>0 0</row></grid></map>' missing_row
instance "$agents" '<map><grid width="2" height="1"><row>0 0 0 0</row></grid></map>' overlong_row
instance "$agents" '<map><grid width="2" height="1"><row></row></grid></map>' empty_row
instance "$agents" '<map><grid width="2" height="1"><row>1 0</row></grid></map>' blocked_start
instance '<agents number="2"><agent start.x="0" start.y="0" goal.x="1" goal.y="0"/><agent start.x="0" start.y="0" goal.x="0" goal.y="0"/></agents>' "$grid" same_start
instance '<agents number="1"><agent start.x="0" start.y="0" goal.x="2" goal.y="0"/></agents>' '<map><grid width="3" height="1"><row>0 1 0</row></grid></map>' unreachable
instance '<agents number="1"><agent start.x="0" start.y="0" goal.x="9" goal.y="0"/></agents>' "$grid" outside
instance "${agents/<agent /<agent size=\"nan\" }" "$grid" nan_size
instance "${agents/<agent /<agent size=\"-1\" }" "$grid" negative_size
instance "$agents" '<map><grid width="1000000000" height="1000000000"><row>0 0</row></grid></map>' huge
instance "$agents" '<map><grid width="nan" height="-3"><row>0 0</row></grid></map>' nan_grid
: >bad/empty.xml
printf 'type octile\nheight 1000000000\nwidth 1000000000\nmap\n.\n' >bad/huge.scen
for file in bad/*; do
  refused "$file" plan --instance "$file" -o written.xml --svg written.svg
  mkdir one && cp "$file" one/
  refused "one/${file#bad/}" bench --instances one --db history.db
  rm -r one
done
refused 'directory' plan --instance bad -o written.xml
refused 'line|:1|:2' plan --instance bad/blocked_start.xml
if [ -e written.xml ] || [ -e written.svg ]; then complain "bad input wrote something"; fi

# Output that cannot be written.
refused 'space|full' plan --instance warehouse/0.xml -o /dev/full
refused 'space|full' plan --instance warehouse/0.xml --svg /dev/full
refused 'nowhere' plan --instance warehouse/0.xml -o nowhere/plan.xml
"$sipplab" plan --instance warehouse/0.xml >/dev/full 2>err
equal "$?" 2 "exit code with stdout full"
"$sipplab" plan --instance warehouse/0.xml --json 2>err >&-
equal "$?" 2 "exit code with stdout closed"
equal "$(wc -l <err)" 1 "lines on stderr with stdout closed"
# A pipe that had a reader, and has none for sure when it is written to.
mkfifo gone
exec 5<>gone 4>gone 5>&-
"$sipplab" plan --instance warehouse/0.xml --json 2>err >&4
equal "$?" 141 "exit code when the reader has gone"
equal "$(cat err)" '' "words when the reader has gone"
exec 4>&-

# A disk that fills up during a sweep, where a small one can be mounted.
mkdir full
# shellcheck disable=SC2016
if unshare --mount --map-root-user true 2>/dev/null &&
  unshare --mount --map-root-user bash -c 'mount -t tmpfs -o size=400k none full &&
    { "$0" bench --suite density --robots 8 --count 30 --max-restarts 0 --db full/history.db >/dev/null 2>err
      echo $? >code; sqlite3 full/history.db "PRAGMA integrity_check" >integrity; }' "$sipplab" 2>/dev/null; then
  equal "$(cat code)" 2 "exit code with the disk full"
  says 'no space' err
  equal "$(cat integrity)" ok "integrity with the disk full"
fi

# No permission: as somebody else where we are root.
install -m 000 /dev/null secret.xml
if [ "$(id -u)" -ne 0 ]; then
  refused 'secret.xml.*ermission' plan --instance secret.xml
elif command -v setpriv >/dev/null; then
  setpriv --reuid=65534 --regid=65534 --clear-groups "$sipplab" plan --instance secret.xml >out 2>err
  equal "$?" 2 "exit code without permission"
  says 'secret.xml.*ermission' err
fi

equal "$(dump)" "$before" "the history after bad input"

# --- what happens to a sweep ------------------------------------------------------

# A map that would be written over by what is made from it.
mkdir own
expect 0 generate --map empty:5x5 --agents 1 --count 1 --format movingai -o own
refused 'own/0.map is the map' generate --map own/0.map --agents 2 --count 1 --format movingai -o own

# interrupted_sweep SIGNAL CASES: sends the signal to a sweep once so many cases are begun;
# sets `count` and `code`. How long a sweep takes depends on the machine and the build, so it
# grows until the signal comes in time.
sweep=(bench --suite smoke --robots 24 --db killed.db)
begun_cases() { sqlite3 killed.db 'SELECT count(*) FROM cell' 2>/dev/null || echo 0; }
interrupted_sweep() {
  local victim
  for count in 16 64 256 1024 4096; do
    rm -f killed.db*
    "$sipplab" "${sweep[@]}" --count "$count" >/dev/null 2>err &
    victim=$!
    until [ "$(begun_cases)" -ge "$2" ] || ! kill -0 $victim 2>/dev/null; do :; done
    kill -"$1" $victim 2>/dev/null
    code=0
    wait $victim 2>/dev/null || code=$?
    [ "$(sqlite3 killed.db 'SELECT status FROM run')" = finished ] || break
  done
}

# Killed at any moment: what was done until a second before is there, and --resume does the rest.
interrupted_sweep KILL 3
equal "$code" 137 "exit code after SIGKILL"
equal "$(sqlite3 killed.db 'SELECT status FROM run')" running "run after SIGKILL"
equal "$(sqlite3 killed.db 'PRAGMA integrity_check')" ok "integrity after SIGKILL"
equal "$(sqlite3 killed.db 'SELECT count(*) FROM cell WHERE result_count <> (SELECT count(*) FROM result WHERE cell_id = cell.id)')" 0 "half cases"
results() { sqlite3 killed.db 'SELECT cell_id, instance_id, position, repetition, planning_time_ns FROM result WHERE attempt_id = 1'; }
results >kept
[ -s kept ] || complain "nothing of a killed sweep was kept"
expect 0 "${sweep[@]}" --count "$count" --resume
says 'resuming' err
results | cmp -s - kept || complain "--resume did plannings again"
equal "$(sqlite3 killed.db 'SELECT status, missing, attempts FROM v_sweeps')" "finished|0|2" "sweep after --resume"
equal "$(sqlite3 killed.db 'SELECT group_concat(status) FROM v_attempts')" "aborted,finished" "attempts"
# Of a finished run nothing is left to do.
expect 0 "${sweep[@]}" --count "$count" --resume
says 'plannings are there' err
equal "$(sqlite3 killed.db 'SELECT count(*) FROM attempt')" 2 "attempts after resuming a finished run"
expect 0 "${sweep[@]}" --count "$count" --resume "$(sqlite3 killed.db 'SELECT substr(uuid, 1, 8) FROM run')"
refused 'is not of this sweep and build' "${sweep[@]}" --count 2 --resume "$(sqlite3 killed.db 'SELECT uuid FROM run')"
refused 'no run 12345678' "${sweep[@]}" --count "$count" --resume 12345678

# Beside a writer that lives nobody else writes.
"$sipplab" "${sweep[@]}" --count 1024 >/dev/null 2>err &
writer=$!
is_written() { [ "$(sqlite3 killed.db "SELECT count(*) FROM run WHERE status = 'running'")" = 1 ]; }
comes is_written || complain "no sweep under way"
refused 'is being written' "${sweep[@]}" --count 1024 --resume
# A scheduler's last word: the planning at hand is given up, what was done is kept.
kill -TERM $writer
code=0
wait $writer 2>/dev/null || code=$?
equal "$code" 143 "exit code after SIGTERM"
equal "$(sqlite3 killed.db "SELECT count(*) FROM run WHERE status = 'aborted'")" 1 "runs after SIGTERM"

# Ctrl-C: the record is closed, the exit code tells, the next step is named.
interrupted_sweep INT 1
equal "$code" 130 "exit code after Ctrl-C"
says 'resume' err
equal "$(sqlite3 killed.db 'SELECT status FROM run')" aborted "run after Ctrl-C"

[ "$broken" -eq 0 ] && echo "all promises kept"
exit "$((broken > 0))"
