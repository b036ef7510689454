#pragma once
// The replay's script, last part: buttons and sliders, and what starts it all.

#include <string_view>

namespace dem::report::detail {

inline constexpr std::string_view kReplayScriptPage = R"JS(
// ---- buttons and sliders

function make(tag, properties, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}
function labelled(text, ...inputs) {
  return make("label", {}, make("span", {textContent: text}), ...inputs);
}
function choice(names, chosen, changed) {
  const select = make("select", {}, ...names.map((name, value) => make("option", {value, textContent: name})));
  select.value = chosen;
  select.addEventListener("change", () => changed(Number(select.value)));
  return select;
}
function ticked(text, checked, changed) {
  const check = make("input", {type: "checkbox", checked});
  check.addEventListener("change", () => changed(check.checked));
  return make("label", {}, check, make("span", {textContent: text}));
}
function slider(most, step, value, moved) {
  const input = make("input", {type: "range", min: 0, max: most, step});
  input.value = value;
  input.addEventListener("input", () => moved(Number(input.value)));
  return input;
}
const inWords = (x) => x === 0 ? "0" : Math.abs(x) >= 1e-3 && Math.abs(x) < 1e5 ? String(Number(x.toPrecision(3))) : x.toExponential(1);
const count = (n) => n.toLocaleString("en-US");
function lengthInWords(x) {
  const [factor, unit] = x >= 1 ? [1, "m"] : x >= 1e-3 ? [1e3, "mm"] : [1e6, "\u00b5m"];
  return `${inWords(x * factor)} ${unit}`;
}

// Seconds of the run for a second of watching: 1, 2 and 5 times powers of ten, and which of them takes 10 s or so.
function rates(span) {
  const best = Math.log10((span || 1) / 10), list = [];
  for (let power = Math.floor(best) - 1; power <= best + 2; ++power) {
    for (const digit of [1, 2, 5]) list.push(Number((digit * 10 ** power).toPrecision(1)));
  }
  const off = (rate) => Math.abs(Math.log10(rate) - best);
  return {list, chosen: list.reduce((a, rate, k) => off(rate) < off(list[a]) ? k : a, 0)};
}

function legend(view) {
  const colours = [];
  for (let k = 0; k < 256; k += 15) colours.push(`rgb(${view.map.slice(4 * k, 4 * k + 3).join(",")})`);
  const title = make("div", {}), ends = make("div", {className: "ends"}), bar = make("div", {className: "bar"});
  bar.style.background = `linear-gradient(to right, ${colours.join(",")})`;
  const box = make("div", {className: "legend"}, title, bar, ends);
  const show = ({name, unit, most, value, ends: words}) => {
    box.hidden = !value;
    title.textContent = unit ? `${name} (${unit})` : name;
    const numbers = () => [0, 0.5, 1].map((t) => (t === 1 ? "\u2265 " : "") + inWords(t * most));
    ends.replaceChildren(...(words || numbers()).map((textContent) => make("span", {textContent})));
  };
  return {box, show};
}

// What the page cannot know of the run itself.
function notes(head) {
  const times = head.times, step = Math.max(...[0, 1, 2].map((k) => head.high[k] - head.low[k])) / 131070;
  const every = times.length > 1 ? `, one every ${inWords((times[times.length - 1] - times[0]) / (times.length - 1))} s` : "";
  const some = head.seen > head.grains ? `${count(head.grains)} of ${count(head.seen)} grains, chosen evenly` : `${count(head.grains)} grains`;
  return `${some}; ${count(times.length)} frames${every}. Places are good to ${lengthInWords(step)}, rotations to 0.3\u00b0. ` +
      "Drag to turn, with Shift or the right button to move; wheel to zoom; double-click for the first view.";
}

function controls(figure, view) {
  const times = view.head.times, last = times.length - 1, span = times[last] - times[0];
  const digits = Math.max(0, Math.min(9, 1 - Math.floor(Math.log10(span / Math.max(1, last) || 1))));
  const {list, chosen} = rates(span);
  let rate = list[chosen], playing = false, stamp = 0;
  const button = make("button", {type: "button"});
  const setPlaying = (value) => {
    playing = value;
    button.textContent = playing ? "\u23f8\ufe0e Pause" : "\u25b6\ufe0e Play";
    button.setAttribute("aria-pressed", playing);
  };
  const tick = (now) => {
    if (!playing) return;
    const time = Math.min(times[last], view.time + rate * Math.min(0.25, (now - stamp) / 1000));
    stamp = now;
    view.setTime(time);
    if (time === times[last]) setPlaying(false); else requestAnimationFrame(tick);
  };
  button.addEventListener("click", () => {
    setPlaying(!playing);
    if (view.time === times[last]) view.setTime(times[0]);
    requestAnimationFrame((now) => {
      stamp = now;
      tick(now);
    });
  });
  setPlaying(false);
  const clock = make("output", {className: "clock"});
  const position = slider(last, 1, 0, (frame) => {
    setPlaying(false);
    view.setTime(times[frame]);
  });
  position.setAttribute("aria-label", "time");
  const {box, show} = legend(view);
  view.canvas.parentNode.append(box);
  let shown = null;
  view.drawn = (frame, scale) => {
    if (shown !== scale) show(shown = scale);
    if (playing || Number(position.value) !== frame) position.value = frame;
    clock.textContent = `${view.time.toFixed(digits)} s`;
    figure.dataset.frame = frame;
  };

  let colour = view.grains.length > 0 ? 0 : view.colourings.length - 1, ofFrame = false;
  const recolour = () => view.setColouring(view.colourings[colour], ofFrame);
  recolour();
  const rows = [labelled("speed of play", choice(list.map((r) => `\u00d7 ${inWords(r)}`), chosen, (k) => rate = list[k]))];
  if (view.grains.length > 0) {
    let axis = -1, share = 0.5;
    const cut = () => view.setCut(axis, share);
    const where = slider(1, 0.005, share, (value) => [share = value, cut()]);
    where.disabled = true;
    where.setAttribute("aria-label", "place of the cut");
    const along = choice(["none", "across x", "across y", "across z"], 0, (k) => {
      axis = k - 1;
      where.disabled = axis < 0;
      cut();
    });
    const names = view.colourings.map(({name}) => name);
    rows.unshift(labelled("colour", choice(names, colour, (k) => [colour = k, recolour()]),
                          choice(["scale of the run", "scale of each frame"], 0, (k) => [ofFrame = k === 1, recolour()])));
    rows.push(labelled("cut", along, where), ticked("grains", true, (value) => {
      view.setGrains(value);
      box.hidden = !value || !view.colouring.value;
    }));
  }
  if (view.forces) {
    const name = `force chains (widest: \u2265 ${inWords(view.forces.most)} N)`;
    rows.push(ticked(name, false, (value) => view.setForces(value)));
  }
  if (view.parts.length > 0) {
    const opacity = view.grains.length > 0 ? 0.12 : 1;
    rows.push(labelled("solidity of parts", slider(1, 0.01, opacity, (value) => view.setOpacity(value))));
  }
  const reset = make("button", {type: "button", textContent: "First view"});
  reset.addEventListener("click", () => view.orbit.reset());
  rows.push(reset);
  const boxes = view.parts.map((part) => ticked(part.name, true, (value) => {
    part.wanted = value;
    view.redraw();
  }));
  const parts = make("details", {hidden: boxes.length === 0}, make("summary", {textContent: "Parts"}), ...boxes);
  return make("div", {className: "controls"}, make("div", {}, button, position, clock), make("div", {}, ...rows), parts,
              make("small", {textContent: notes(view.head)}));
}

// ---- the start

async function start(figure) {
  const message = figure.querySelector(".message");
  try {
    if (typeof DecompressionStream === "undefined") {
      throw new Error("This browser is too old for the replay: it needs Chrome 80, Firefox 113, Safari 16.4 or later.");
    }
    const canvas = make("canvas", {tabIndex: 0});
    canvas.setAttribute("aria-label", "replay; arrow keys turn, + and - zoom");
    const options = {antialias: true, alpha: true, preserveDrawingBuffer: true};
    const context = canvas.getContext("webgl2", options) || canvas.getContext("webgl", options);
    if (!context) {
      throw new Error("The replay needs WebGL, which this browser does not offer: switch on hardware acceleration, or try another browser.");
    }
    const head = JSON.parse(figure.querySelector(".head").textContent);
    const bytes = await unpack(figure.querySelector(".data").textContent);
    const frame = make("div", {className: "view"}, canvas);
    message.replaceWith(frame);
    const view = new View(head, bytes, canvas, context);
    frame.after(controls(figure, view));
    new ResizeObserver(() => view.resize()).observe(frame);
    view.resize();
    view.orbit.reset();
    figure.demReplay = view;  // for whoever wants to look into it
    figure.dataset.state = "ready";
  } catch (error) {
    const text = figure.isConnected && message.isConnected ? message : figure.querySelector(".view");
    text.className = "message";
    text.textContent = error.message;
    figure.dataset.state = "failed";
  }
}
for (const figure of document.querySelectorAll("figure.replay")) start(figure);
)JS";

}  // namespace dem::report::detail
