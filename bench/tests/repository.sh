#!/usr/bin/env bash
# What is in the repository, and no more: nothing new at the top level, Markdown files with titles and
# with links that lead somewhere, a short README in each folder with code, and includes as the tables of
# the READMEs allow them, without circles between folders. Prints one line for each thing that is not as it should be.
#
#   repository.sh FOLDER
set -uo pipefail
cd "$1" || exit 1
files=$(git ls-files 2>/dev/null)
if [ -z "$files" ]; then
  echo 'skipped: no checkout of git'
  exit 77
fi
broken=0
complain() {
  printf 'BROKEN: %s\n' "$*"
  broken=1
}

while read -r name; do
  case "$name" in
    CMakeLists.txt | CMakePresets.json | CHANGELOG.md | CONTRIBUTING.md | LICENSE | README.md | .*) ;;
    planner | bench | fuzz | property_tests | db | scripts) ;;
    *) complain "$name at the top level" ;;
  esac
done < <(cut -d/ -f1 <<<"$files" | sort -u)

while read -r name; do
  [ -f "$name" ] || continue
  read -r title <"$name"
  [[ $title == '# '[^\ ]* ]] || complain "$name has no title"
done < <(grep '\.md$' <<<"$files")
# A line of git grep is FILE:](LINK) or FILE:](LINK#SECTION).
while IFS= read -r found; do
  name=${found%%:*} link=${found#*:](}
  link=${link%%[)#]*}
  [ -z "$link" ] || [ -e "./${name%"${name##*/}"}$link" ] || complain "$name: the link $link leads nowhere"
done < <(git grep -oE '\]\([^)#:]*(#[^)]*)?\)' -- '*.md')

# Lines: the README of the root can be read in one go, that of a folder fits on a screen.
short() { # FILE LINES
  local lines
  mapfile -t lines <"$1"
  [ "${#lines[@]}" -le "$2" ] || complain "$1 has ${#lines[@]} lines, expected at most $2"
}
short README.md 150
while read -r folder; do
  if [ -f "$folder/README.md" ]; then short "$folder/README.md" 60; else complain "$folder has no README.md"; fi
done < <(sed -nE 's,/[^/]*\.(cpp|hpp|py)$,,p' <<<"$files" | sort -u)

# The interface: few headers, which include only each other.
interface=planner/include/sipplab
headers=$(grep -c "^$interface/.*\.hpp$" <<<"$files")
[ "$headers" -le 15 ] || complain "$headers headers in $interface, expected at most 15"
while read -r line; do complain "$line, which is not installed"; done < <(
  git grep -E '^#include "' -- "$interface/*.hpp" | grep -v '"sipplab/'
)

# Folder of a file, folder of what it includes, file. A header of the interface counts as part of the folder that defines it.
includes=$(git grep -E '^#include "[^"]+/[^"]+"' -- '*.cpp' '*.hpp' | sed -E 's/:#include "/ /; s/"$//' |
  awk -v interface="$interface" '
    function folder_of(path) {
      sub("^sipplab/", interface "/", path)
      if (path in home) return home[path]
      sub("/[^/]*$", "", path)
      return path
    }
    NR == FNR { if (split($0, column, " *[|] *") == 5 && gsub("`", "", column[2])) home[interface "/" column[2]] = "planner/" column[3]; next }
    { print folder_of($1), folder_of($2), $1 }
  ' $interface/README.md - | sort -u)
for header in $interface/*.hpp; do
  grep -q "^| \`${header##*/}\` | " $interface/README.md || complain "$interface/README.md has no row for ${header##*/}"
done
# Whatever the tables say: the program and the libraries contain no test code.
while read -r _ to file; do
  case "$file" in bench/tests/* | db/tests/*) continue ;; esac
  case "$to" in property_tests/* | fuzz | fuzz/* | bench/tests | db/tests) complain "$file includes $to, which is test code" ;; esac
done < <(grep -E '^(planner|db|bench)/' <<<"$includes")
# The tables whose last column is called `includes`: a folder, below `prefix`, includes itself and what stands there,
# which is a folder below `prefix` or one from the root with all that is in it; `all` stands for everything.
check_table() { # FILE PREFIX
  awk -v table="$1" -v prefix="$2" '
    function below(path, folder) { return path == folder || index(path, folder "/") == 1 }
    NR == FNR {
      if ($0 !~ /^\|/) in_table = 0
      if ($0 ~ /\| includes \|$/) in_table = 1
      if (!in_table || split($0, column, " *[|] *") != 5 || column[2] !~ /`/) next
      gsub("^[[]|[]].*|`", "", column[2]) # of a link its text
      sub("/$", "", column[2])
      folder = column[2] == "." ? substr(prefix, 1, length(prefix) - 1) : prefix column[2]
      gsub("`", "", column[4])
      allowed[folder] = column[4]
      next
    }
    {
      from = $1
      if (prefix == "") sub("/.*", "", from) # all that is below the folders of the root
      if (!(from in allowed)) {
        if (prefix != "" && below($1, substr(prefix, 1, length(prefix) - 1)))
          print table " has no row for " $1
        next
      }
      rows[from] = 1
      fine = prefix == "" ? below($2, from) : $2 == from
      count = split(allowed[from], names, ", *")
      for (i = 1; i <= count && !fine; ++i)
        fine = names[i] == "all" || $2 == prefix names[i] || $2 == names[i] || below($2, names[i]) && !below(names[i] "/", prefix)
      if (!fine) print $3 " includes " $2 ", which " table " does not allow"
    }
    END {
      if (length(allowed) == 0) print table " has no table of includes"
      for (folder in allowed) if (!(folder in rows) && allowed[folder] != "") print table ": " folder " includes nothing"
    }
  ' "$1" <(printf '%s\n' "$includes") | sort -u
}
while read -r line; do complain "$line"; done < <(
  check_table README.md ''
  check_table planner/README.md planner/
  check_table bench/README.md bench/
)

# Folders that include each other, however far round.
circle=$(awk '$1 != $2 { print $1, $2 }' <<<"$includes" | tsort 2>&1 >/dev/null |
  sed -n '/input contains/!s/^tsort: //p' | awk '!seen[$0]++' | tr '\n' ' ')
[ -z "$circle" ] || complain "folders include each other in a circle: $circle"

[ "$broken" -eq 0 ] && echo 'repository: everything in its place'
exit "$broken"
