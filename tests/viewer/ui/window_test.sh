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
# Nothing that a user keeps, or that an earlier run left, may answer here.
export XDG_STATE_HOME=$work/state XDG_CONFIG_HOME=$work/config XDG_CACHE_HOME=$work/cache

"$tumble" open "$here/window_scene.json" --size 1200x780 --status-file "$status" --captures "$work" \
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
chord() { # MODIFIER KEY
  xdotool keydown "$1"
  tap "$2"
  xdotool keyup "$1"
}
click() { # on a body or widget
  point "$1"
  pictures 2 >/dev/null
  xdotool mousedown 1
  pictures 2 >/dev/null
  xdotool mouseup 1
}
distance='([.eye, .pivot] | transpose | map(.[0] - .[1] | . * .) | add | sqrt)'
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
chord shift period
until_true ".tick == $tick + 10" "Shift+. steps ten"
chord shift comma
until_true ".tick == $tick" "Shift+, steps ten back"
tap r
until_true '.tick == 0' "R restarts"
tap space
until_true '.paused | not' "Space goes on"
tap minus
until_true '.speed == 0.5' "- halves the speed"
tap equal
until_true '.speed == 1' "= doubles it"

xdotool key 1 2 3 4 5 7 8 9
until_true '.overlays | sort == ["aabbs", "collision_shape", "contacts", "forces", "friction_cones", "grid",
  "joints", "normals"]' \
  "digits show what is drawn over the scene"
tap 0
until_true '.overlays == []' "0 shows none"
tap F3
until_true '.panels | any(. == "statistics")' "F3 shows the statistics"
tap F4
until_true '.panels | any(. == "energy")' "F4 shows the energy"
tap Tab
until_true '.panels == []' "Tab hides the panels"
tap Tab
until_true '.panels == ["statistics", "energy"]' "Tab shows them again"
tap F1
until_true '.widgets | has("help.Ctrl+F12") and has("help.Space")' "F1 shows help"
tap Escape
until_true '.panels | any(. == "help") | not' "Esc closes it"
chord shift question
until_true '.panels | any(. == "help")' "? shows help"
tap Escape
tap F3
tap F4
until_true '.panels == []' "F3 and F4 hide theirs"

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
depth=$(last '.points.box.x[2]')
xdotool click 4 click 4 click 4
until_true ".points.box.x[2] > $depth + 0.3" "the wheel pulls it nearer"
depth=$(last '.points.box.x[2]')
xdotool click 5 click 5 click 5 click 5
until_true ".points.box.x[2] < $depth - 0.3" "the wheel pushes it away"
xdotool keydown shift
for _ in $(seq 60); do
  [ "$(last '.turn.box < 0.98')" = true ] && break
  xdotool mousemove_relative -- 6 0
  pictures 1 >/dev/null
done
until_true '.turn.box < 0.98' "Shift turns the held body"
xdotool keyup shift
xdotool mouseup 1
until_true ".dragging | not" "it is let go"
until_true ".points.box.x[1] < $height + 0.3" "it falls back"

point '.widgets["transport.pause"]'
pictures 2
xdotool mousedown 1
pictures 2
xdotool mouseup 1
until_true '.paused' "the pause button pauses"

pictures 2
tick=$(last .tick) here_hash=$(last .state_hash)
tap F5
tap comma
until_true ".tick == $tick - 1" "',' steps back behind the snapshot"
pictures 2
before_hash=$(last .state_hash)
tap space
until_true ".tick > $tick + 20" "time goes on"
tap space
until_true '.paused' "and stands again"
tap F7
until_true ".tick == $tick and .state_hash == \"$here_hash\"" "F7 restores the snapshot"
tap comma
until_true ".tick == $tick - 1 and .state_hash == \"$before_hash\"" \
  "a step back from it gives the state that was there"

xdotool mousemove 500 600
pictures 2
away=$(last "$distance")
xdotool click 4 click 4
until_true "$distance < $away - 0.5" "the wheel comes nearer"
xdotool click 5 click 5
until_true "$distance > $away - 0.1" "the wheel goes back"
side=$(last '.pivot[0]')
xdotool mousedown 2
pictures 2
xdotool mousemove_relative -- 60 0
until_true ".pivot[0] < $side - 0.2" "a middle drag pans"
xdotool mouseup 2
yaw='(.eye[0] - .pivot[0]) / (.eye[2] - .pivot[2])'
turned=$(last "$yaw")
xdotool mousedown 1
pictures 2
xdotool mousemove_relative -- -60 0
until_true "$yaw > $turned + 0.1" "a left drag beside bodies orbits"
xdotool mouseup 1
pictures 30
point .points.box.at
pictures 2
xdotool click 1 click 1
until_true '[.pivot, .points.box.x] | transpose | map(.[0] - .[1] | . * .) | add < 1' \
  "a double click makes that point the pivot"
until_true '.selected.name == "box"' "and a click selects"
tap Delete
until_true '.points | has("box") | not' "Del deletes the selected body"
xdotool mousemove 500 600
pictures 2
xdotool keydown shift
pictures 2
xdotool click 1
until_true '.points | has("shot")' "Shift and left shoots a ball"
xdotool keyup shift
tap r
until_true '.points | has("box") or has("shot") | not' "R takes the ball away, and keeps the box deleted"
chord ctrl z
pictures 5
chord ctrl z
until_true '.points | has("box")' "Ctrl+Z brings the box back"
tap r
pictures 5

xdotool mousemove 500 600
pictures 2
xdotool mousedown 3
pictures 2
fly() { # KEY, COORDINATE of the eye, +1 or -1: which way it goes while the key is held
  local from=$(last ".eye[$2]")
  xdotool keydown "$1"
  until_true "(.eye[$2] - $from) * $3 > 0.4" "$1 flies while right is held"
  xdotool keyup "$1"
  pictures 2
}
fly w 2 -1
fly s 2 1
fly d 0 1
fly a 0 -1
fly e 1 1
fly q 1 -1
xdotool mouseup 3
pictures 2
pivot=$(last .pivot)
xdotool key a d e
pictures 3
[ "$(last .pivot)" = "$pivot" ] || fail "letters fly without the right button"

tap period
until_true '.tick == 1' "a tick goes by"  # what is set before the first tick stays through R
click '.widgets["inspector.close"]'
until_true '.panels == []' "the body's panel closes"
click '.widgets["bar.settings"]'
until_true '.widgets | has("settings.tick_hz") and has("settings.threads")' "the settings open"
point '.widgets["settings.tick_hz"]'
pictures 2
xdotool mousedown 1
pictures 2
for _ in $(seq 20); do
  xdotool mousemove_relative -- 3 0
  pictures 1 >/dev/null
  [ "$(last '.settings.tick_hz > 65')" = true ] && break
done
xdotool mouseup 1
until_true '.settings.tick_hz > 65' "dragging changes the tick"
point '.widgets["settings.substeps"]'
pictures 2
xdotool keydown ctrl
pictures 2
xdotool mousedown 1
pictures 2
xdotool mouseup 1 keyup ctrl
pictures 2
xdotool type --delay 60 9
tap Return
until_true '.settings.substeps == 9' "Ctrl and a click make a field to type in: the substeps"
[ "$(last .overlays)" = "$(echo '[]' | jq .)" ] || fail "a digit typed into a field is no command"
click '.widgets["settings.broad_phase"]'
until_true '.widgets | has("settings.broad_phase.aabb_tree")' "the broad phases open as a list"
click '.widgets["settings.broad_phase.aabb_tree"]'
until_true '.settings.broad_phase == "aabb_tree"' "a click chooses one"
until_true '.widgets | has("settings.broad_phase.aabb_tree") | not' "and closes the list"
drag_right() { # WIDGET JQ WHAT: to the right until it is true
  point ".widgets[\"$1\"]"
  pictures 2
  xdotool mousedown 1
  pictures 2
  for _ in $(seq 40); do
    [ "$(last "$2")" = true ] && break
    xdotool mousemove_relative -- 4 0
    pictures 1 >/dev/null
  done
  xdotool mouseup 1
  until_true "$2" "$3"
}
drag_right settings.threads '.threads == ('"$(nproc)"')' "dragging gives the world more threads"
[ "$(last .paused)" = true ] && tap space
xdotool keydown shift # ten times as fast
drag_right settings.gravity '.settings.gravity[1] > 0' "dragging turns gravity over"
xdotool keyup shift
until_true '.points.box.x[1] > 2' "and the box flies up"
tick=$(last .tick)
tap r
until_true ".tick < $tick"' and .settings.tick_hz > 65 and .settings.gravity[1] > 0 and .settings.substeps == 9
  and .settings.broad_phase == "aabb_tree"' "R keeps the settings that were chosen"
chord shift r
until_true '.settings.tick_hz == 60 and .settings.gravity[1] < -9 and .settings.substeps < 9
  and .settings.broad_phase == "uniform_grid"' "Shift+R brings the scene's settings back"

window=$(xdotool search --name ' - Tumble' | head -n 1)
xdotool windowsize "$window" 420 320
until_true '.widgets | has("bar.menu")' "a narrow window has a menu"
until_true '[.widgets[] | .[0] < 420 and .[1] < 320] | all' "nothing is cut off"
click '.widgets["bar.menu"]'
until_true '.widgets | has("bar.energy")' "the menu opens"
click '.widgets["bar.energy"]'
until_true '.panels | any(. == "energy")' "and shows a panel"
xdotool windowsize "$window" 1200 700
until_true '.widgets | has("bar.menu") | not' "a wide one has words"
tap F4
click '.widgets["bar.settings"]'
until_true '.panels | any(. == "settings" or . == "energy") | not' "the words of the bar close panels"

double_click() { # BODY: until it is the pivot; clicks that a busy machine takes apart are repeated
  for _ in $(seq 8); do
    point ".points.$1.at"
    pictures 2 >/dev/null
    xdotool click --repeat 2 --delay 90 1
    for _ in $(seq 10); do
      pictures 1 >/dev/null
      [ "$(last "[.pivot, .points.$1.x] | transpose | map(.[0] - .[1] | . * .) | add < 0.8")" = true ] &&
        { echo "ok: $2"; return; }
    done
  done
  fail "$2"
}
close_inspector() {
  [ "$(last '.widgets | has("inspector.close")')" = true ] && click '.widgets["inspector.close"]'
  until_true '.panels == []' "no panel is open"
}
for size in "1280 720" "420 320"; do
  xdotool windowsize "$window" $size
  until_true '.widgets | has("bar.menu") == '"$([ "$size" = "420 320" ] && echo true || echo false)" \
    "the window is $size"
  double_click box "a double click on the box"
  # To where the body's panel is, or would be.
  xdotool mousedown 2
  pictures 2
  xdotool mousemove_relative -- $((${size%% *} / 3)) 0
  until_true '[.pivot, .points.box.x] | transpose | map(.[0] - .[1] | . * .) | add > 1' "the box is aside"
  xdotool mouseup 2
  pictures 30
  close_inspector
  double_click box "a double click on it where a panel opens"
  [ "$size" = "1280 720" ] && until_true '.panels == ["inspector"]' "which has opened"
  [ "$size" = "420 320" ] && until_true '.panels == []' "but none where it would cover the body"
  close_inspector
done
xdotool windowsize "$window" 1200 700
until_true '.widgets | has("bar.menu") | not' "the window is wide again"

width() { xdotool getwindowgeometry --shell "$(xdotool search --name ' - Tumble' | head -n 1)" |
  sed -n 's/^WIDTH=//p'; }
until_width() {
  for _ in $(seq 300); do
    [ "$(width)" = "$1" ] && { echo "ok: $2"; return; }
    sleep 0.1
  done
  fail "$2"
}
tap F11
until_true '.full_screen' "F11 asks for full screen"
until_width 1280 "the window fills the screen"
tap F11
until_true '.full_screen | not' "F11 leaves it"
until_width 1200 "the window has its size again"

tap F9
until_true '.recording' "F9 starts a sequence"
pictures 4
xdotool windowsize "$window" 900 650
until_width 900 "the window has another size"
pictures 4
tap F9
until_true '.recording | not' "F9 ends it"
xdotool windowsize "$window" 1200 700
list=$(echo "$work"/tumble-*-sequence-000/frames.json)
jq -e '.complete and (.frames | length) >= 4 and
  all(.frames[]; (.state_hash | test("^0*$") | not) and (.image_hash | test("^0*$") | not)) and
  ([.frames[].tick] | . == ([range(.[0]; .[0] + length)]))' "$list" >/dev/null ||
  fail "frames.json lacks a hash or a tick: $(head -c 2000 "$list")"
[ "$(ls "${list%/*}"/frame_*.png | wc -l)" = "$(jq '.frames | length' "$list")" ] ||
  fail "not every frame is on disk"
for f in "${list%/*}"/frame_*.png; do
  [ "$(od -An -tu1 -j16 -N8 "$f" | tr -s ' ')" = " 0 0 4 176 0 0 2 188" ] || fail "$f is not 1200 x 700"
done
echo "ok: the sequence has its frames and their hashes, all of one size"

tap F12
until_true '.captured | length == 1' "F12 takes a screenshot"
file=$(last '.captured[0]')
head -c 8 "$file" | od -An -tx1 | grep -q '89 50 4e 47' || fail "$file is no PNG"
chord ctrl F12
until_true '.captured | length == 2' "Ctrl+F12 takes one without panels"
cmp -s "$file" "$(last '.captured[1]')" && fail "the panels are in it"

chord ctrl o
until_true '.widgets | has("scenes.search")' "Ctrl+O opens the search"
xdotool type --delay 60 hell
until_true '.widgets | has("scenes.hello") and (has("scenes.arch") | not)' "it finds by letters"
tap Return
until_true '.scene == "hello"' "Enter opens the scene"
tap bracketright
until_true '.scene != "hello"' "] opens the next"
tap bracketleft
until_true '.scene == "hello"' "[ goes back"

if [ -n "$drop" ]; then
  "$drop" "$here/dropped_scene.json" || fail "the drop was not taken"
  until_true '.scene == "dropped_scene"' "a dropped file loads"
  [ "$(last .paused)" = true ] && tap space
  until_true '.points.egg.x[1] < 0.45 and (.eye[1] - .points.egg.x[1] | fabs) < 0.05' \
    "the camera follows the body that the scene says"
  echo '{ "tumble_scene": 1, "bodies": { "egg": { "shap": 1 } } }' >"$work/broken.json"
  "$drop" "$work/broken.json" || fail "the drop was not taken"
  until_true '.toasts | any(contains("broken.json"))' "a faulty file is reported"
  [ "$(last .scene)" = dropped_scene ] || fail "the scene went with the faulty file"
  tap Escape
  until_true '.toasts | any(contains("broken.json")) | not' "Esc closes the report"
fi

xdotool keydown bracketright keyup bracketright # closing waits for no scene
chord ctrl q
for _ in $(seq 100); do
  kill -0 "$app" 2>/dev/null || break
  sleep 0.1
done
wait "$app"
code=$?
app=
[ "$code" = 0 ] || fail "Ctrl+Q gave exit code $code"
echo "ok: Ctrl+Q ends it with 0"
