# Sourced by scripts that judge builds of commits; $root is the checkout that they belong to.

# build_tree FOLDER: builds the checkout in FOLDER; its program is FOLDER/build/release/sipplab.
build_tree() {
  (cd "$1" && cmake --preset release >/dev/null && cmake --build --preset release --target sipplab) >&2
}

# build_commit COMMIT: builds a commit in build/base, unless a build of it is there, from a cache for example.
# Sets $program.
build_commit() {
  local tree=$root/build/base/$1
  program=$tree/build/release/sipplab
  [ ! -x "$program" ] || [ ! -e "$tree/built" ] || return 0
  if [ ! -e "$tree/CMakeLists.txt" ]; then
    rm -rf "$tree" # of a build that was stopped
    git -C "$root" worktree prune
    git -C "$root" worktree add --quiet --detach "$tree" "$1" || return
  fi
  build_tree "$tree" && touch "$tree/built"
}

# expects_changes BASE: whether a commit after BASE says in its message that plans differ: "Plans: changed".
# (grep -q would end at the first line, and with pipefail a git that cannot write on fails it all.)
expects_changes() {
  git -C "$root" log --format='%(trailers:key=Plans,valueonly)' "$1..HEAD" | grep -ix 'changed' >/dev/null
}
