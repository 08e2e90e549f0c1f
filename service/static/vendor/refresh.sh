#!/usr/bin/env bash
# Bundles the released packages that the page uses, one file each, and notes version, licence and digest in README.md.
# Run after changing a version here (`make vendor`); needs node and npm. Users need neither: the bundles are committed.
set -euo pipefail
cd "$(dirname "$0")"
VENDOR=$PWD WORK=$(mktemp -d)
trap 'rm -rf "$WORK"' EXIT
cd "$WORK"
npm install --silent --no-package-lock --no-save \
  esbuild@0.28.2 three@0.187.0 lit-html@3.3.3 eventsource@5.1.5 eventsource-parser@4.1.3

cat > three.js <<'END'
export {
  PerspectiveCamera, Scene, ShaderMaterial, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
export { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
END
cat > lit-html.js <<'END'
export { html, nothing, render, svg } from "lit-html";
export { repeat } from "lit-html/directives/repeat.js";
export { guard } from "lit-html/directives/guard.js";
export { live } from "lit-html/directives/live.js";
export { ref } from "lit-html/directives/ref.js";
export { classMap } from "lit-html/directives/class-map.js";
END
echo 'export { EventSource } from "eventsource";' > eventsource.js

field() { node -p "require('./node_modules/$1/package.json').$2"; }
{
  echo "# Packages from npm, bundled"
  echo
  echo "Written by \`refresh.sh\` (\`make vendor\`), which holds the versions; each file begins with its licence. Nothing is edited by hand."
  echo
  echo "| file | holds | licence | bytes | sha256 |"
  echo "| --- | --- | --- | --: | --- |"
} > "$VENDOR/README.md"
bundle() { # name of the file and of the package, other packages inside
  local held="" licence
  for package in "$@"; do held+="${held:+, }$package $(field "$package" version)"; done
  licence=$(cat "node_modules/$1/LICENSE")
  npx esbuild "$1.js" --bundle --minify --format=esm --target=es2022 --legal-comments=inline \
    --banner:js="/* $held"$'\n\n'"$licence */" --outfile="$VENDOR/$1.js" --log-level=warning
  echo "| \`$1.js\` | $held | $(field "$1" license) | $(wc -c < "$VENDOR/$1.js") | \`$(sha256sum "$VENDOR/$1.js" | cut -c1-64)\` |" >> "$VENDOR/README.md"
}
bundle three
bundle lit-html
bundle eventsource eventsource-parser
