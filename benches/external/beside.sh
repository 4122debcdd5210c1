#!/usr/bin/env bash
# Builds the columns that can be built on this machine, and runs `sixfold study` with them:
#
#   benches/external/beside.sh bunny.obj --budget 60s --report beside
#
# LIBRARIES="lox cgal" selects columns. The programs are built in target/columns. SIXFOLD is the program to
# run; the default is the release build of this repository.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=$here/../../target/columns
mkdir -p "$out"
out=$(cd "$out" && pwd)
export PATH=$out/rust/release:$out/cpp:$PATH
columns=${LIBRARIES:-lox alum parry3d tri-mesh openmesh cgal opensubdiv}

for name in $columns; do
    case $name in lox | alum | parry3d | tri-mesh | openmesh | cgal | opensubdiv) ;;
    *) echo "no column is called $name" >&2; exit 2 ;;
    esac
done
wanted() { [[ " $columns " == *" $1 "* ]]; }
externals=()
for name in lox alum parry3d tri-mesh; do
    wanted "$name" || continue
    cargo build --release --locked --manifest-path "$here/rust/Cargo.toml" --target-dir "$out/rust" -p "$name-column"
    externals+=(--external "$name=$name-column {mesh}")
done
if wanted openmesh || wanted cgal || wanted opensubdiv; then
    if ! { cmake -S "$here/cpp" -B "$out/cpp" && cmake --build "$out/cpp"; } >"$out/cpp.log" 2>&1; then
        echo "cannot build the C++ columns: they need g++, cmake, nlohmann-json3-dev and the libraries; see $out/cpp.log" >&2
        rm -f "$out/cpp/openmesh" "$out/cpp/cgal" "$out/cpp/opensubdiv"
    fi
    for name in openmesh cgal opensubdiv; do
        if wanted "$name" && [ -x "$out/cpp/$name" ]; then
            externals+=(--external "$name=$name {mesh}")
        fi
    done
fi
if [ -z "${SIXFOLD:-}" ]; then
    cargo build --release --locked --manifest-path "$here/../../Cargo.toml" -p sixfold-cli
    SIXFOLD=$here/../../target/release/sixfold
fi
exec "$SIXFOLD" study "$@" "${externals[@]}"
