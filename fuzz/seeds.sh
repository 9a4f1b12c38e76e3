#!/bin/sh
# Gathers seeds into fuzz/corpus/TARGET from Debian's assimp-testmodels (when installed) and from the shipped models.
# apt-get install assimp-testmodels
set -eu
here=$(cd "$(dirname "$0")" && pwd)
models=${1:-/usr/share/assimp/models}
[ -d "$models" ] || echo "seeds.sh: $models is not there; install assimp-testmodels for more seeds" >&2

# gather TARGET PATTERN...: copies files of at most 200 kB, named by their content.
gather() {
    target=$1
    shift
    mkdir -p "$here/corpus/$target"
    for pattern in "$@"; do
        find "$models" "$here/../models" -type f -iname "$pattern" -size -200k 2>/dev/null
    done | while read -r file; do
        cp "$file" "$here/corpus/$target/$(sha256sum "$file" | cut -c1-16)"
    done
    echo "$target: $(find "$here/corpus/$target" -type f | wc -l) seeds"
}

gather obj '*.obj'
gather mtl '*.mtl'
gather stl '*.stl'
gather ply '*.ply'
gather gltf '*.gltf' '*.glb'
gather ppm '*.ppm' '*.pgm'
gather texture '*.png' '*.jpg' '*.jpeg' '*.ppm'
gather face '*.mesh' '*.png' '*.stl'
