#!/usr/bin/env bash
# The real window on a virtual display, driven by real pointer and key events.
# usage: window_test.sh TUMBLE FOLDER_OF_THIS_TEST [XDND_DROP]
# Reference: the world's own state as the window's status file tells it. 77: skipped, no Xvfb here.
set -u
tumble=$1 here=$2 drop=${3:-}
for tool in Xvfb xdotool jq; do
  command -v $tool >/dev/null || { echo "skipped: $tool is not installed"; exit 77; }
done
work=$(mktemp -d) status=$work/status.jsonl
display=
cleanup() {
  [ -n "${app:-}" ] && kill "$app" 2>/dev/null
  [ -n "${xvfb:-}" ] && kill "$xvfb" 2>/dev/null
  wait 2>/dev/null
  rm -rf "$work"
}
trap cleanup EXIT
fail() {
  echo "FAILED: $*"
  tail -n 1 "$status" 2>/dev/null | cut -c 1-600
  cat "$work/log" 2>/dev/null
  exit 1
}

exec 3>"$work/display"
Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp 2>/dev/null &
xvfb=$!
for _ in $(seq 100); do
  display=$(cat "$work/display")
  [ -n "$display" ] && break
  sleep 0.1
done
[ -n "$display" ] || fail "Xvfb does not start"
export DISPLAY=:$display

"$tumble" open "$here/window_scene.json" --status-file "$status" --captures "$work" \
  >"$work/log" 2>&1 &
app=$!

last() { tail -n 2 "$status" 2>/dev/null | head -n 1 | jq -r "$1" 2>/dev/null; }
# until_true JQ WHAT: waits until the expression is true of what the window shows
until_true() {
  for _ in $(seq 300); do
    [ "$(last "$1")" = true ] && { echo "ok: $2"; return; }
    kill -0 "$app" 2>/dev/null || fail "the window has gone before: $2"
    sleep 0.1
  done
  fail "$2"
}
pictures() { # waits for N more pictures
  local goal=$(($(last .picture) + $1))
  until_true ".picture >= $goal" "$1 more pictures"
}
tap() { # a key held for a few frames
  xdotool keydown "$1"
  sleep 0.15
  xdotool keyup "$1"
}
point() { # moves the pointer to a body or widget
  xdotool mousemove $(last "$1 | map(round) | join(\" \")")
}

until_true '.tick > 5' "the world runs"

tap space
until_true '.paused' "Space pauses"
pictures 2
tick=$(last .tick)
pictures 3
[ "$(last .tick)" = "$tick" ] || fail "time goes on while paused"
tap period
until_true ".tick == $tick + 1" "'.' steps once"
tap comma
until_true ".tick == $tick" "',' steps back"
tap r
until_true '.tick == 0' "R restarts"
tap space
until_true '.paused | not' "Space goes on"

height=$(last '.points.box.x[1]')
point .points.box.at
pictures 2
xdotool mousedown 1
pictures 2
for _ in $(seq 20); do
  xdotool mousemove_relative -- 0 -10
  sleep 0.05
done
until_true '.dragging' "a left drag on a body takes hold of it"
until_true ".points.box.x[1] > $height + 0.5" "the mouse spring lifts the body"
until_true '.selected.name == "box"' "the body is selected"
xdotool mouseup 1
until_true ".dragging | not" "it is let go"
until_true ".points.box.x[1] < $height + 0.3" "it falls back"

point '.widgets["transport.pause"]'
pictures 2
xdotool mousedown 1
pictures 2
xdotool mouseup 1
until_true '.paused' "the pause button pauses"

tap F12
until_true '.captured | length == 1' "F12 takes a screenshot"
file=$(last '.captured[0]')
head -c 8 "$file" | od -An -tx1 | grep -q '89 50 4e 47' || fail "$file is no PNG"

if [ -n "$drop" ]; then
  "$drop" "$here/dropped_scene.json" || fail "the drop was not taken"
  until_true '.scene == "dropped_scene"' "a dropped file loads"
fi

xdotool keydown ctrl
tap q
xdotool keyup ctrl
for _ in $(seq 100); do
  kill -0 "$app" 2>/dev/null || break
  sleep 0.1
done
wait "$app"
code=$?
app=
[ "$code" = 0 ] || fail "Ctrl+Q gave exit code $code"
echo "ok: Ctrl+Q ends it with 0"
