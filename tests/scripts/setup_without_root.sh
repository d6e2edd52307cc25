#!/bin/sh
# scripts/setup as a user who may not install: names what is missing in one line, and prints the
# options that leave out the parts that need it.
set -eu
setup=$1
shims=$(mktemp -d)
trap 'rm -rf "$shims"' EXIT

printf '#!/bin/sh\necho 1000\n' >"$shims/id"
printf '#!/bin/sh\nexit 1\n' >"$shims/sudo"  # not permitted
cat >"$shims/dpkg-query" <<'SHIM'
#!/bin/sh
for package; do :; done  # the last argument
case " $MISSING " in *" $package "*) exit 1 ;; esac
echo installed
SHIM
chmod +x "$shims"/*

expect() {  # MISSING OPTIONS LINES
  options=$(MISSING=$1 PATH=$shims:$PATH "$setup" 2>"$shims/error" | tr '\n' ' ')
  if [ "$options" != "$2" ] || [ "$(wc -l <"$shims/error")" -ne "$3" ]; then
    echo "without '$1': '$options', not '$2':" >&2
    cat "$shims/error" >&2
    exit 1
  fi
}
expect "" "" 0
expect "libode-dev libgtest-dev libgmock-dev" "-DBROADMARK_ODE=OFF -DBROADMARK_TESTS=OFF " 1
expect "valgrind" "" 1
grep -q ': valgrind$' "$shims/error"
