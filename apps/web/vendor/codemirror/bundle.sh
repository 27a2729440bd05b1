#!/bin/bash
# bundle.sh: makes editor.js and LICENSE of the versions that package-lock.json names. Needs npm, esbuild and a network;
# only to change the version, because the page is built of the files in this folder.
#
# editor.js has a script for each package, so that the page can run them one by one: none takes long. Each begins with the
# line "// part NAME" and adds what its package exports to globalThis.crescentEditor.
set -e
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$here"/{package.json,package-lock.json} "$work"
cd "$work"
npm ci --ignore-scripts --no-audit --no-fund
# The page's policy allows its own style alone: style-mod must add its rules as a style sheet object, which it does in a
# shadow root only, and not as an element.
sed -i 's/if (!root.head && root.adoptedStyleSheets && win.CSSStyleSheet)/if (root.adoptedStyleSheets \&\& win.CSSStyleSheet)/' \
    node_modules/style-mod/src/style-mod.js
grep -q 'if (root.adoptedStyleSheets && win.CSSStyleSheet)' node_modules/style-mod/src/style-mod.js
# In the order in which they need each other.
parts="@codemirror/state @codemirror/view @lezer/common @lezer/highlight @lezer/lr @lezer/javascript @codemirror/language
    @codemirror/commands @codemirror/lint @codemirror/autocomplete @codemirror/lang-javascript"
{
    echo "/* CodeMirror 6 and its packages, MIT License: LICENSE beside this file. Made by bundle.sh. */"
    for part in $parts; do
        others=$(for other in $parts; do [ "$other" = "$part" ] || echo "--external:$other"; done)
        echo "// part $part"
        echo '(()=>{const all=globalThis.crescentEditor??={},require=(name)=>all[name],module={exports:{}};'
        # shellcheck disable=SC2086
        esbuild "$part" --bundle --minify --format=cjs --target=es2022 --charset=utf8 --legal-comments=none \
            --platform=browser --main-fields=module --conditions=import $others
        echo "all[\"$part\"]=module.exports;Object.assign(all,module.exports)})();"
    done
} >"$here/editor.js"
{
    echo "editor.js contains these packages:"
    for package in node_modules/@codemirror/* node_modules/@lezer/* node_modules/@marijn/* node_modules/crelt \
        node_modules/style-mod node_modules/w3c-keyname; do
        node -p "const p = require('./$package/package.json'); '  ' + p.name + ' ' + p.version"
    done
    echo
    cat node_modules/@codemirror/view/LICENSE
} >"$here/LICENSE"
