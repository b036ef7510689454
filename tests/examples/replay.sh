#!/usr/bin/env bash
# The replay of a report in a headless browser: the page loads without errors and asks for nothing from outside, frames
# advance, mouse, keys and controls change the picture. Leaves replay_*.png in the output folder, to look at.
#
#   replay.sh <replay_page> <output folder>
set -euo pipefail

program=$1 output=$2
probe=$(cd "$(dirname "$0")" && pwd)/replay_probe.js
three=${DEM_THREE_JS:-/usr/share/javascript/three/three.min.js}

skip() {
  echo "$1: the replay is not tried in a browser"
  exit 77
}
fail() {
  printf '%s\n' "$@"
  exit 1
}

for browser in chromium chromium-browser google-chrome none; do
  ! command -v "$browser" > /dev/null || break
done
[ "$browser" != none ] || skip "chromium is not installed"
[ -r "$three" ] || skip "libjs-three is not installed"

rm -rf "$output"
mkdir -p "$output"
output=$(cd "$output" && pwd)
"$program" "$output"

profile=$(mktemp -d)
pid=
stop() {
  [ -z "$pid" ] || kill "$pid" 2> /dev/null || true
  [ -z "$pid" ] || wait "$pid" 2> /dev/null || true
  pid=
}
trap 'stop; rm -rf "$profile"' EXIT

# start <options>...: a browser that draws by the processor, and is told what to do through a pipe: messages of JSON,
# each with a zero byte behind it.
start() {
  stop
  session="" calls=0
  rm -f "$profile/in" "$profile/out"
  mkfifo "$profile/in" "$profile/out"
  HOME=$profile "$browser" --headless --no-sandbox --disable-gpu --disable-quic --no-first-run \
    --disable-background-networking --disable-component-update --disable-sync --disable-dev-shm-usage \
    --user-data-dir="$profile/data" --use-angle=swiftshader --enable-unsafe-swiftshader --hide-scrollbars \
    --window-size=900,1000 --remote-debugging-pipe "$@" 3< "$profile/in" 4> "$profile/out" 2> "$output/browser.log" &
  pid=$!
  exec 5> "$profile/in" 6< "$profile/out"
  call Target.createTarget '{"url":"about:blank"}'
  call Target.attachToTarget "{\"targetId\":\"$(field targetId)\",\"flatten\":true}"
  session=",\"sessionId\":\"$(field sessionId)\""
  for domain in Page Runtime Log; do call $domain.enable '{}'; done
}
# call <method> <parameters>: leaves the browser's answer in $reply; what it tells besides goes to events.txt.
call() {
  calls=$((calls + 1))
  printf '{"id":%d,"method":"%s","params":%s%s}\0' "$calls" "$1" "$2" "$session" >&5
  while IFS= read -r -d '' -t 500 reply <&6; do
    case $reply in
      "{\"id\":$calls,\"error\""*) fail "The browser refuses $1: $reply" ;;
      "{\"id\":$calls,"*) return ;;
      *) printf '%s\n' "$reply" >> "$output/events.txt" ;;
    esac
  done
  fail "The browser does not answer $1; see $output/browser.log"
}
# field <name>: a text in the last answer.
field() { printf '%s' "$reply" | sed -n "s/.*\"$1\":\"\([^\"]*\)\".*/\1/p"; }
# evaluate <expression>: its value, text, in the last answer; a promise is waited for.
evaluate() { call Runtime.evaluate "{\"expression\":\"$1\",\"awaitPromise\":true,\"returnByValue\":true}"; }
# open_page <file>: and wait until the replay is there.
open_page() {
  call Page.navigate "{\"url\":\"file://$1\"}"
  evaluate "new Promise((done) => { const look = () => { const f = document.querySelector('figure.replay'); f && f.dataset.state ? done(f.dataset.state) : setTimeout(look, 20); }; look(); })"
}
mouse() { call Input.dispatchMouseEvent "{\"type\":\"$1\",\"x\":$2,\"y\":$3,\"button\":\"left\",\"buttons\":1,\"clickCount\":1,\"deltaX\":0,\"deltaY\":${4:-0}}"; }
expect() {
  local line
  for line in "$@"; do grep -qxF "$line" "$output/probe.txt" || fail "Not so in the browser: $line" "$(cat "$output/probe.txt")"; done
}

start
open_page "$output/report.html"
[ "$(field value)" = ready ] || fail "The replay does not start: $reply"
call Runtime.evaluate "{\"expression\":$(awk '
  BEGIN { printf "\"" } { gsub(/\\/, "\\\\"); gsub(/"/, "\\\""); printf "%s\\n", $0 } END { print "\"" }' "$probe")}"
evaluate 'tryControls()'
printf '%b' "$(field value)" > "$output/probe.txt"
expect 'right grains 50 and 50, wrong 0' 'right turns 100' 'right forces 75 and 25, wrong 0, lost 0, falling 0' 'frame of the start 0' 'frame of the slider 15' 'clock 0.240 s' 'grains are seen true' 'shades are many true' \
  'the same without a change true' 'sand is yellow true' 'legend is hidden true' 'cut hides grains true' \
  'not moved without a button true' 'play advances true' 'pause stops true' 'play ends true' 'requests 0' \
  'legend of sleep asleep or awakeasleepawake' \
  'parts floor|bottom box|top box|wheel <of tin>' 'force chains are off true' 'end true'
grep -q '^legend displacement (m)0.*≥ 0\.0' "$output/probe.txt" || fail "The legend is not that of the displacement" "$(cat "$output/probe.txt")"
[ "$(grep -c '^changed by .* true$' "$output/probe.txt")" = 19 ] ||
  fail "Not all controls change the picture:" "$(cat "$output/probe.txt")"

# The mouse as the browser itself has it.
picture() { evaluate 'look().then((p) => String(p.hash))' && field value; }
evaluate "document.querySelector('canvas').scrollIntoView().value + ''"
first=$(picture)
mouse mousePressed 300 200
mouse mouseMoved 380 240
mouse mouseReleased 380 240
turned=$(picture)
mouse mouseWheel 300 200 -240
zoomed=$(picture)
[ "$first" != "$turned" ] && [ "$turned" != "$zoomed" ] && [ "$first" != "$zoomed" ] || fail "The mouse does not turn and zoom"

# Pictures to look at: grains falling, and sheared, the latter for readers who like it dark; and force chains alone.
picture_to() {
  call Page.captureScreenshot '{"format":"png"}'
  field data | base64 -d > "$output/$1"
  [ "$(wc -c < "$output/$1")" -gt 20000 ] || fail "$1 shows next to nothing"
}
for frame in 1 25; do
  [ $frame != 25 ] || call Emulation.setEmulatedMedia '{"features":[{"name":"prefers-color-scheme","value":"dark"}]}'
  open_page "$output/report.html"
  evaluate "(async () => { const time = document.querySelector('.controls input'); time.value = $frame; time.dispatchEvent(new Event('input')); for (let k = 0; k < 3; ++k) await new Promise(requestAnimationFrame); return ''; })()"
  picture_to replay_$frame.png
done
evaluate "(async () => { for (const box of document.querySelectorAll('.controls > div input[type=checkbox]')) box.click(); for (let k = 0; k < 3; ++k) await new Promise(requestAnimationFrame); return ''; })()"
picture_to replay_chains.png
! cmp -s "$output/replay_1.png" "$output/replay_25.png" || fail "Two frames look the same"

# Errors of scripts, and words of the page to the console. The driver's own word on reading pixels comes from the probe.
! grep -e '"method":"Runtime.exceptionThrown"' -e '"method":"Runtime.consoleAPICalled"' -e '"method":"Log.entryAdded"' \
  "$output/events.txt" | grep -v 'GPU stall due to ReadPixels' || fail "There are errors in the browser"

# Without WebGL there is a plain message.
start --disable-3d-apis
open_page "$output/report.html"
[ "$(field value)" = failed ] || fail "Without WebGL the replay does not know that it has failed"
evaluate "document.querySelector('.replay .message').textContent"
case $(field value) in "The replay needs WebGL"*) ;; *) fail "Without WebGL the page does not say so: $reply" ;; esac
echo "The replay works in $browser"
