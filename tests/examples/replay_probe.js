// Tried out in the page by replay.sh: look() says what the picture is like, tryControls() does everything that a reader
// may do and returns what came of it, a line each.

const figure = document.querySelector("figure.replay"), canvas = figure.querySelector("canvas");
const rest = (time) => new Promise((done) => setTimeout(done, time));

async function look() {
  for (let k = 0; k < 3; ++k) await new Promise(requestAnimationFrame);
  const copy = Object.assign(document.createElement("canvas"), {width: canvas.width, height: canvas.height});
  const context = copy.getContext("2d", {willReadFrequently: true});
  context.drawImage(canvas, 0, 0);
  const {data} = context.getImageData(0, 0, copy.width, copy.height);
  const colours = new Set(), sum = [0, 0, 0];
  let solid = 0, hash = 0;
  for (let k = 0; k < data.length; k += 4) {
    hash = (hash * 31 + data[k] + 256 * data[k + 1] + 65536 * data[k + 2] + data[k + 3]) % 4294967291;
    if (data[k + 3] < 255) continue;
    ++solid;
    for (let c = 0; c < 3; ++c) sum[c] += data[k + c];
    colours.add(data[k] << 16 | data[k + 1] << 8 | data[k + 2]);
  }
  return {hash, solid: solid / copy.width / copy.height, colours: colours.size, mean: sum.map((x) => x / solid)};
}

// How many grains are where replay_page.cpp has put them, and as fast: from frame 5 (0.08 s), when all have landed, to the
// last one (0.4 s) the lower half rests and the upper half goes 3 mm along x. Numbers are good to the steps in which
// they are kept.
function rightGrains() {
  const {head, frames} = figure.demReplay, grains = head.grains, last = frames.count - 1;
  const step = [0, 1, 2].map((axis) => (head.high[axis] - head.low[axis]) / 65535), right = {lower: 0, upper: 0, wrong: 0};
  for (let g = 0; g < grains; ++g) {
    const before = 5 * grains + g, after = last * grains + g;
    const moved = step.map((size, axis) => size * (frames.place[3 * after + axis] - frames.place[3 * before + axis]));
    const speed = head.speed * (frames.scalar[2 * after] / 255) ** 2;
    const goes = (far, fast) => Math.abs(moved[0] - far) <= step[0] && moved[1] === 0 && moved[2] === 0 &&
        Math.abs(speed - fast) <= Math.sqrt(fast * head.speed) / 255 + head.speed / 260100 &&
        frames.turn[before] === frames.turn[after] && frames.asleep[before] === 1 && frames.asleep[after] === (far > 0 ? 0 : 1);
    ++right[goes(0, 0) ? "lower" : goes(3e-3, 3e-3 / 0.32) ? "upper" : "wrong"];
  }
  return `${right.lower} and ${right.upper}, wrong ${right.wrong}`;
}

// How many grains of frame 0 are turned as replay_page.cpp has them, within the 4.9e-3 rad to which turns are kept.
function rightTurns() {
  let right = 0;
  for (const shape of [0, 1]) {
    const turns = figure.demReplay.grains[shape].attributes[1].array;
    for (let n = 0, row = 0; n < 100; ++n) {
      if ((n % 3 === 0) !== (shape === 1)) continue;
      const [i, j, k] = [n % 5, Math.floor(n / 5) % 5, Math.floor(n / 25)];
      const half = (0.2 * Math.sin(2.4 * n) + 30 * Math.min(0.08, 0.03 + 0.006 * k)) / 2, axis = [Math.cos(i), Math.sin(j), 1];
      const expected = [...axis.map((x) => Math.sin(half) * x / Math.hypot(...axis)), Math.cos(half)];
      const away = (sign) => Math.hypot(...expected.map((x, c) => x - sign * turns[4 * row + c] / 32767));
      // By the distance of the quaternions, which is half the angle; 16 bits a component leave out 3e-5 of it.
      right += 2 * Math.min(away(1), away(-1)) < 4.9e-3 + 6e-5 ? 1 : 0;
      ++row;
    }
  }
  return right;
}

// How many force chains are where replay_page.cpp has them, and as large: none while all fall, in the end one under each
// grain, straight down to the next one or to the floor. From frame 5 on each line is known in the next frame.
function rightForces() {
  const {forces: {frames, low, size}, head} = figure.demReplay, place = 1.06 * 2e-3, last = frames[frames.length - 1];
  const most = head.forces.most, right = {down: 0, floor: 0, wrong: 0, lost: 0};
  const at = (k, end, axis) => low[axis] + size[axis] * last.ends[6 * k + 3 * end + axis];
  last.force.forEach((steps, k) => {
    const [x, y, z] = [0, 1, 2].map((axis) => at(k, 0, axis) - at(k, 1, axis)), force = (steps / 255) ** 2 * most;
    // Layers by their heights, of which the lowest bears down on the floor; both ends are off by half a step each.
    const layer = Math.round((at(k, 0, 2) - low[2]) / place - 0.5), expected = 2e-4 * (4 - layer);
    const good = Math.abs(x) <= size[0] && Math.abs(y) <= size[1] &&
        Math.abs(z - (layer === 0 ? 0.5 : 1) * place) <= size[2] &&
        Math.abs(force - expected) <= Math.sqrt(expected * most) / 255 + most / 260100;
    ++right[good ? layer === 0 ? "floor" : "down" : "wrong"];
  });
  for (const {next} of frames.slice(5, -1)) right.lost += next.filter((line) => line < 0).length;
  return `${right.down} and ${right.floor}, wrong ${right.wrong}, lost ${right.lost}, falling ${frames[0].force.length}`;
}

async function tryControls() {
  let lines = "";
  const note = (name, value) => lines += `${name} ${value}\n`;
  const [time, ...sliders] = figure.querySelectorAll("input[type=range]");
  const [colour, scale, speed, cut] = figure.querySelectorAll("select");
  const set = (input, value) => {
    input.value = value;
    for (const type of ["input", "change"]) input.dispatchEvent(new Event(type));
  };
  const pointer = (type, x, y, more) => canvas.dispatchEvent(
      new PointerEvent(type, Object.assign({pointerId: 1, clientX: x, clientY: y, button: 0, bubbles: true}, more)));
  const capture = canvas.setPointerCapture;
  canvas.setPointerCapture = () => {};  // which only a real pointer has
  let before = await look();
  // Does something, and says whether the picture has changed.
  const changes = async (name, action) => {
    action();
    const after = await look();
    note(`changed by ${name}`, after.hash !== before.hash);
    return before = after;
  };

  note("right grains", rightGrains());
  note("right turns", rightTurns());
  note("right forces", rightForces());
  note("the same without a change", (await look()).hash === before.hash);
  note("frame of the start", figure.dataset.frame);
  await changes("time", () => set(time, 15));
  note("frame of the slider", figure.dataset.frame);
  note("clock", figure.querySelector(".clock").textContent);
  note("grains are seen", before.solid > 0.05);
  note("shades are many", before.colours > 500);
  const {mean} = await changes("one colour", () => set(colour, 4));
  note("sand is yellow", mean[0] > mean[2] + 20);
  note("legend is hidden", figure.querySelector(".legend").hidden);
  await changes("asleep or awake", () => set(colour, 3));
  note("legend of sleep", figure.querySelector(".legend").textContent);
  await changes("displacement", () => set(colour, 2));
  note("legend", figure.querySelector(".legend").textContent);
  await changes("scale of the frame", () => [set(time, 3), set(scale, 1)]);

  for (const [name, more] of [["drag", {}], ["drag with Shift", {shiftKey: true}], ["right drag", {button: 2}]]) {
    await changes(name, () => {
      pointer("pointerdown", 300, 300, more);
      pointer("pointermove", 360, 330, more);
      pointer("pointerup", 360, 330, more);
    });
  }
  pointer("pointermove", 500, 500);
  note("not moved without a button", (await look()).hash === before.hash);
  await changes("wheel", () => canvas.dispatchEvent(new WheelEvent("wheel", {deltaY: -300, cancelable: true})));
  await changes("two fingers", () => {
    const second = {pointerId: 2};
    pointer("pointerdown", 300, 300);
    pointer("pointerdown", 400, 300, second);
    pointer("pointermove", 450, 300, second);
    pointer("pointerup", 300, 300);
    pointer("pointerup", 450, 300, second);
  });
  await changes("keys", () => canvas.dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowLeft", cancelable: true})));
  await changes("first view", () => [...figure.querySelectorAll("button")].pop().click());
  const half = await changes("cut", () => set(cut, 2)), less = await changes("place of the cut", () => set(sliders[0], 0.8));
  note("cut hides grains", less.solid < half.solid);
  await changes("solid parts", () => [set(cut, 0), set(sliders[1], 1)]);
  note("parts", [...figure.querySelectorAll("details label")].map((label) => label.textContent).join("|"));
  figure.querySelectorAll("details input[type=checkbox]")[2].click();
  note("part is hidden", (await look()).hash !== before.hash);
  const [grains, chains] = figure.querySelectorAll(".controls > div input[type=checkbox]");
  note("force chains are off", !chains.checked && chains.labels[0].textContent === "force chains (widest: \u2265 8.0e-4 N)");
  set(sliders[1], 0.1);
  before = await look();
  await changes("force chains", () => chains.click());
  await changes("grains left out", () => grains.click());
  await changes("force chains left out", () => chains.click());
  await changes("grains", () => grains.click());

  // At its fastest, so that a slow machine, which shows few pictures a second, need not wait.
  const play = figure.querySelector("button"), frame = () => Number(figure.dataset.frame), last = Number(time.max);
  const until = async (holds) => {
    for (let k = 0; k < 600 && !holds(); ++k) await rest(50);
    return holds();
  };
  set(time, 0);
  await look();
  play.click();
  note("play advances", await until(() => frame() > 0));
  play.click();
  await look();
  const reached = frame();
  await rest(300);
  note("pause stops", reached < last && frame() === reached);
  set(speed, speed.options.length - 1);
  play.click();
  note("play ends", await until(() => play.textContent.includes("Play")) && (await look(), frame() === last));
  note("requests", performance.getEntriesByType("resource").length);
  canvas.setPointerCapture = capture;
  note("end", true);
  return lines;
}
