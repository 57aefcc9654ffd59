#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# without.sh TREE RUNNER WORK: no display, no browser, no gnuplot: each is said in one line, and the rest is made; a script that fails leaves no
# page. The functions are those of `run`, without its last part, which does what the words of its command line say.
set -euo pipefail
tree=$1 program=$2 work=$3
rm -rf "$work"
mkdir -p "$work/empty"
bad() { printf 'without.sh: %s\n' "$*" >&2; exit 1; }
one_line() { # one_line TEXT WORDS: it is one line, with these words
    if [ "$(grep -c '' <<<"$1")" != 1 ] || [[ $1 != *"$2"* ]]; then bad "wanted one line with '$2', got: $1"; fi
}
lone=$work/scene.lua
cat >"$lone" <<'END'
local impact, plot = require "impact", require "quat.plot"
return impact.scene { name = "lone", duration = 1, bodies = { impact.body { name = "ball", shape = impact.sphere(0.1) } },
  plot = function() return plot.figure { plot.panel { plot.line { { 0, 1 }, { 0, 1 } } } } end }
END

# shellcheck disable=SC1090
source <(sed '/^command=/,$d' "$tree/run")
set +e

# no display, and one
said=$(DISPLAY='' WAYLAND_DISPLAY='' open_page "$work/x.html")
[ "$(uname)" = Darwin ] || one_line "$said" "$work/x.html is for any browser"
printf '#!/bin/sh\necho "$%s" >%q\n' 1 "$work/opened" >"$work/empty/xdg-open"
chmod +x "$work/empty/xdg-open"
(PATH=$work/empty:$PATH DISPLAY=:0 open_page "$work/x.html"; wait)
[ "$(uname)" = Darwin ] || [ "$(cat "$work/opened")" = "$work/x.html" ] || bad "a page is opened where there is a display"
rm "$work/empty/xdg-open"

# no browser
# shellcheck disable=SC2329
have_command() { return 1; }
said=$(out=$work draw_pages) || bad "no browser is no failure"
one_line "$said" "no Chromium"

# no gnuplot: the page, the rows and the record are made
said=$(PATH=$work/empty "$program" view "$lone" --out "$work/made" --quiet 2>&1) || bad "no gnuplot is no failure: $said"
one_line "$said" "gnuplot is not installed"
for file in lone.html lone.csv lone.run; do [ -s "$work/made/$file" ] || bad "$file is missing where there is no gnuplot"; done

# what fails leaves no page
printf 'error "broken"\n' >"$work/wrong.lua"
sed 's/duration = 1,/duration = 1, max_events = 1, gravity = { 0, 0, -9.81 },/; s/bodies = {/bodies = { impact.body { name = "floor", restitution = 1, shape = impact.plane(), position = { 0, 0, -0.2 } },/' \
    "$lone" >"$work/halfway.lua"
for script in wrong halfway; do
    ! said=$("$program" view "$work/$script.lua" --out "$work/failed" --quiet 2>&1) || bad "$script.lua does not fail"
    one_line "$said" impact:
    [ -z "$(find "$work/failed" -name '*.html' 2>/dev/null)" ] || bad "$script.lua leaves a page"
done
echo "1 passed, 0 failed"
