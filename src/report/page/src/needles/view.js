// The three-dimensional view with its controls: turning, frames, colours.
import { choice, element, freshId, slider, toggle, whenNear } from "../dom.js";
import { decode } from "../data.js";
import { boundaryText, openSides } from "../boundaries.js";
import { numberText } from "../numbers.js";
import { blueToRedOn, gradientOf, scales } from "../charts/colours.js";
import { figureOf } from "../charts/figure.js";
import { onTheme, colourOfTheme } from "../theme.js";
import { NeedleScene } from "./scene.js";

/** What needles are coloured by: how their range follows from the values of a frame, and whether
 * its middle is a zero between two directions. */
const colouringsOf = ({ flow_axis: axis }) => ({
  speed: { text: "speed", unit: "length / time", range: (values) => [0, 2.5 * rootMeanSquare(values)] },
  spin: { text: "spin", unit: "radians / time", range: (values) => [0, 2.5 * rootMeanSquare(values)] },
  flow: { text: `flow along ${"xyz"[axis]}`, unit: "(T_tr / m)^½", range: () => [-1.5, 1.5], diverging: true },
  alignment: { text: "alignment with the velocity", unit: "Q = 3 cos² − 1", range: () => [-1, 2] },
  density: { text: "local density", unit: "of the mean", range: () => [0, 2] },
});

/** Of walls, as variables of the page's style. */
const colourOfKind = { "wall": "--muted", "moving wall": "--curve-2", "thermal wall": "--curve-1" };

function rootMeanSquare(values) {
  const sum = values.reduce((total, value) => total + value * value, 0);
  return Math.sqrt(sum / values.length) || 1;
}

const reducedMotion = matchMedia("(prefers-reduced-motion: reduce)");

/** `frames`: what the report holds of the frames of a run. */
export function needlesView(frames) {
  return new NeedlesView(frames).figure;
}

class NeedlesView {
  constructor(frames) {
    this.frames = frames;
    this.colourings = colouringsOf(frames);
    this.current = frames.frames.length - 1;
    this.colouring = "speed";
    this.playing = null;
    this.canvas = element("canvas", { tabindex: 0, role: "application", "aria-roledescription": "view in three dimensions" });
    this.stage = element("div", { class: "stage" }, this.canvas);
    this.print = element("img", { class: "printed", alt: "" });
    this.bar = element("div", { class: "colour-bar" });
    this.spoken = element("div", { class: "spoken", "aria-live": "polite" });
    const help = freshId("keys");
    this.canvas.setAttribute("aria-describedby", help);
    this.figure = figureOf(
      {
        title: "Needles",
        caption: captionOf(frames),
        notes: notesOf(frames),
        wide: true,
      },
      {
        tools: this.makeTools(),
        body: element(
          "div",
          {},
          this.stage,
          this.print,
          this.makePlayer(),
          this.bar,
          this.spoken,
          element(
            "p",
            { class: "keys", id: help },
            "Drag to turn, scroll or pinch to zoom. Keys: arrows turn, + and − zoom, space plays, comma and full stop step, Home starts over.",
          ),
        ),
        columns: () => this.columns(),
      },
    );
    this.figure.view = this;
    this.loadFrame(this.current);
    whenNear(this.stage, () => this.start());
  }

  start() {
    try {
      this.scene = new NeedleScene(this.canvas, this.frames);
    } catch {
      this.stage.replaceChildren(
        element("p", { class: "missing" }, "This browser has no WebGL, so the needles cannot be drawn. The table below has them as numbers."),
      );
      return;
    }
    this.canvas.addEventListener("keydown", (event) => this.onKey(event));
    this.resize();
    this.showFrame(this.current);
    new ResizeObserver(() => this.resize()).observe(this.stage);
    onTheme(() => this.recolour());
    window.addEventListener("beforeprint", () => {
      this.scene.draw();
      this.print.src = this.canvas.toDataURL();
    });
  }

  makeTools() {
    const available = Object.entries(this.colourings).map(([key, { text }]) => [key, text]);
    const turning = toggle("Turn", false, (pressed) => this.setTurning(pressed));
    return [
      choice("Colour by", available, this.colouring, (key) => {
        this.colouring = key;
        this.recolour();
        this.say(`Coloured by ${this.colourings[key].text}`);
      }),
      turning,
    ];
  }

  makePlayer() {
    const last = this.frames.frames.length - 1;
    this.position = slider("Frame", last, this.current, (n) => this.textOf(n), (n) => this.showFrame(n));
    this.playButton = toggle("Play", false, (pressed) => this.setPlaying(pressed));
    const step = (label, by) =>
      element("button", { type: "button", "aria-label": label, click: () => this.step(by) }, by < 0 ? "‹" : "›");
    if (last === 0) this.playButton.disabled = true;
    return element("div", { class: "player" }, this.playButton, step("Previous frame", -1), step("Next frame", 1), this.position);
  }

  textOf(n) {
    const { number, time } = this.frames.frames[n];
    const text = time === null ? "" : `, time ${numberText(time)}`;
    return `${number}${text}`;
  }

  loadFrame(n) {
    this.current = n;
    this.values = Object.fromEntries(Object.keys(this.colourings).map((key) => [key, null]));
    this.describe();
  }

  showFrame(n) {
    this.loadFrame(n);
    const frame = this.frames.frames[n];
    this.scene?.showFrame({
      low: frame.low,
      high: frame.high,
      walls: frame.walls,
      position: decode(frame.position),
      orientation: decode(frame.orientation),
    });
    this.recolour();
    this.figure.refreshTable();
  }

  recolour() {
    const { text, unit, range, diverging } = this.colourings[this.colouring];
    const values = this.valuesOf(this.colouring);
    const [low, high] = range(values);
    const colourAt = diverging ? blueToRedOn(isStageDark() ? "dark" : "light") : sequentialColours();
    if (this.scene) {
      const palette = Array.from({ length: 256 }, (_, n) => colourAt(n / 255));
      this.scene.showPalette(palette, colourOfTheme("--stage"), colourOfTheme("--muted"));
      this.scene.showWallColours((kind) => colourOfTheme(colourOfKind[kind]));
      this.scene.showColours(values, [low, high]);
      this.scene.draw();
    }
    const gradient = element("span", { class: "gradient" });
    gradient.style.background = gradientOf(colourAt);
    this.bar.replaceChildren(
      element("span", {}, `${text} (${unit})`),
      element("span", { class: "ends" }, element("span", {}, numberText(low, 3)), gradient, element("span", {}, numberText(high, 3))),
    );
    this.describe();
  }

  describe() {
    const { needles_shown: shown } = this.frames;
    const { text } = this.colourings[this.colouring];
    const description = `${numberText(shown)} needles in a box that is ${boundaryText(this.frames)}, frame ${this.textOf(this.current)}, coloured by ${text}`;
    this.canvas.setAttribute("aria-label", description);
    this.print.alt = description;
  }

  valuesOf(key) {
    this.values[key] ??= decode(this.frames.frames[this.current][key]);
    return this.values[key];
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.stage;
    if (!width || !height) return;
    this.scene.resize(width, height);
    this.scene.draw();
  }

  step(by) {
    const count = this.frames.frames.length;
    this.position.set((this.current + by + count) % count);
    this.showFrame((this.current + by + count) % count);
  }

  setPlaying(on) {
    clearTimeout(this.playing);
    this.playing = null;
    this.playButton.setAttribute("aria-pressed", String(on));
    this.playButton.textContent = on ? "Pause" : "Play";
    if (!on) return this.say(`Frame ${this.textOf(this.current)}`);
    const pause = reducedMotion.matches ? 1000 : 120;
    const next = () => {
      this.step(1);
      this.playing = setTimeout(next, pause);
    };
    this.playing = setTimeout(next, pause);
  }

  setTurning(on) {
    cancelAnimationFrame(this.turning);
    if (!on) return;
    let before = null;
    const speed = reducedMotion.matches ? 0.05 : 0.3; // radians per second
    const next = (now) => {
      if (before !== null) this.scene?.turn((-speed * (now - before)) / 1000, 0);
      before = now;
      this.turning = requestAnimationFrame(next);
    };
    this.turning = requestAnimationFrame(next);
  }

  onKey(event) {
    const angle = 0.12;
    const actions = {
      ArrowLeft: () => this.scene.turn(-angle, 0),
      ArrowRight: () => this.scene.turn(angle, 0),
      ArrowUp: () => this.scene.turn(0, -angle),
      ArrowDown: () => this.scene.turn(0, angle),
      "+": () => this.scene.zoom(1 / 1.15),
      "=": () => this.scene.zoom(1 / 1.15),
      "-": () => this.scene.zoom(1.15),
      " ": () => this.setPlaying(this.playing === null),
      ",": () => this.stepAndSay(-1),
      ".": () => this.stepAndSay(1),
      Home: () => this.scene.lookAtBox(),
    };
    if (!actions[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    actions[event.key]();
  }

  stepAndSay(by) {
    this.step(by);
    this.say(`Frame ${this.textOf(this.current)}`);
  }

  say(text) {
    this.spoken.textContent = text;
  }

  columns() {
    const frame = this.frames.frames[this.current];
    const position = decode(frame.position);
    const orientation = decode(frame.orientation);
    const part = (values, axis, factor, from = 0) =>
      Float64Array.from({ length: values.length / 3 }, (_, n) => from + values[3 * n + axis] * factor);
    const axes = ["x", "y", "z"];
    const unit = (axis) => (frame.high[axis] - frame.low[axis]) / 65536;
    return [
      ...axes.map((name, axis) => ({ name, values: part(position, axis, unit(axis), frame.low[axis]) })),
      ...axes.map((name, axis) => ({ name: `u_${name}`, values: part(orientation, axis, 1 / 32767) })),
      ...Object.entries(this.colourings).map(([key, { text }]) => ({ name: text, values: this.valuesOf(key) })),
    ];
  }

  /** For tests: what was drawn. */
  get statistics() {
    return { ...this.scene.statistics, frame: this.current };
  }
}

function isStageDark() {
  return colourOfTheme("--stage-is-dark").trim() === "1";
}

// Yellow on white and dark blue on black cannot be told from the ground.
function sequentialColours() {
  const [from, to] = isStageDark() ? [0.3, 1] : [0, 0.82];
  return (share) => scales.needles(from + (to - from) * share);
}

function captionOf(frames) {
  const { periodic, walls } = frames;
  const text = `Drawn in the box, which is ${boundaryText(frames)}, at the places of their centres.`;
  const across = periodic.includes(true) ? " Needles that cross a periodic side stand out of it." : "";
  const where = walls.length ? " Walls are where they are at the time of the frame." : "";
  const above = openSides(frames).length ? " At an open side the edges reach to the farthest needle of this frame and those after it." : "";
  return text + across + where + above;
}

function notesOf(frames) {
  const notes = [];
  if (frames.needles_shown < frames.needles_in_file) {
    notes.push(`Drawn are ${numberText(frames.needles_shown)} of ${numberText(frames.needles_in_file)} needles, evenly chosen.`);
  }
  if (frames.frames.length < frames.frames_in_file) {
    notes.push(`Shown are ${frames.frames.length} of ${frames.frames_in_file} frames, evenly chosen.`);
  }
  notes.push(
    "Local density counts the centres in a ball around each that holds 30 others in the mean. Flow is their mean velocity along the axis along which there is most of it in the last frame.",
  );
  return notes;
}
