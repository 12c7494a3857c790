// The needles of one frame in three dimensions: one draw call for all of them, one for the box, and
// two for each wall.
import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { openSides } from "../boundaries.js";
import { numbers } from "../data.js";
import { Wall } from "./wall.js";

// A needle is a ribbon of four corners that faces the viewer; of a rod of finite width, what is
// beyond its round ends is left out. The GPU places it, so that another frame
// or another colour is another array and nothing else. Each corner has the data of its needle: drawing
// instances of one ribbon would save that, but is ten times slower where a CPU draws.
const vertexShader = `
  attribute vec2 corner;       // along and across the needle, -1/2 or 1/2
  attribute vec3 centre;       // of the box, 0 to 1
  attribute vec3 orientation;
  attribute float value;
  attribute float shareOfLength;  // of the longest needles
  uniform vec3 box;
  uniform float needleLength;
  #ifdef RODS
  attribute float shareOfDiameter;  // of the widest rods
  varying vec2 onRibbon;              // on the ribbon, in radii; the ends of the axis are at ends
  varying float ends;
  varying vec3 onPlane;               // where the ribbon is, seen from the viewer
  varying vec3 towards;               // from the ribbon to the surface, where that is nearest
  #endif
  uniform vec2 range;
  uniform float pixel;         // size at distance 1
  uniform float width;
  uniform vec2 depth;
  uniform sampler2D palette;
  uniform vec3 background;
  uniform vec3 neutral;
  varying vec3 lit;            // colour of the needle in the fog of its distance
  varying vec3 ground;         // what the fog adds
  varying float across;
  void main() {
    vec4 middle = viewMatrix * vec4((centre - 0.5) * box, 1.0);
    vec3 along = mat3(viewMatrix) * orientation * (needleLength * shareOfLength);
    #ifdef RODS
    // The outline of a rod seen from a direction is that of its axis, projected, with round ends. The
    // ribbon goes through the axis; each of its points has the depth of the surface above it, so that
    // rods which cross hide each other where they do, and an edge of the box only where it is in front.
    float radius = max(0.5 * width * shareOfDiameter, 0.55 * pixel * -middle.z);
    vec3 view = normalize(middle.xyz);
    vec3 sideways = along - view * dot(along, view);
    float projected = length(sideways);
    vec3 e1 = projected > 1e-6 * radius ? sideways / projected : normalize(cross(view, vec3(0.3, 0.5, 0.8)));
    vec3 e2 = cross(view, e1);
    vec3 place = middle.xyz + corner.x * (along + 2.0 * radius * e1) + 2.0 * corner.y * radius * e2;
    ends = 0.5 * projected / radius;
    onRibbon = vec2(2.0 * corner.x * (ends + 1.0), 2.0 * corner.y);
    onPlane = place;
    towards = -radius * view;
    #else
    vec3 place = middle.xyz + corner.x * along;
    vec3 side = cross(along, place);
    float least = 1.1 * pixel * -place.z;
    float size = max(width, least);
    place += corner.y * size * side / max(length(side), 1e-6);
    #endif
    gl_Position = projectionMatrix * vec4(place, 1.0);
    float share = (value - range.x) / (range.y - range.x);
    bool defined = value == value;
    vec3 colour = defined ? texture2D(palette, vec2(clamp(share, 0.002, 0.998), 0.5)).rgb : neutral;
    float fog = 0.6 * clamp((-middle.z - depth.x) / (depth.y - depth.x), 0.0, 1.0);
    lit = colour * (1.0 - fog);
    ground = background * fog;
    across = corner.y;
  }`;

const fragmentShader = `
  varying vec3 lit;
  varying vec3 ground;
  varying float across;
  #ifdef RODS
  varying vec2 onRibbon;
  varying float ends;
  varying vec3 onPlane;
  varying vec3 towards;
  uniform vec2 lens;           // what the projection makes of distances
  #endif
  void main() {
    #ifdef RODS
    vec2 off = vec2(max(abs(onRibbon.x) - ends, 0.0), onRibbon.y);
    float square = dot(off, off);
    if (square > 1.0) discard;
    float height = sqrt(1.0 - square);
    float z = onPlane.z + towards.z * height;
    gl_FragDepth = clamp(0.5 - 0.5 * (lens.x + lens.y / z), 0.0, 1.0);
    gl_FragColor = vec4(lit * (0.35 + 0.65 * height) + ground, 1.0);
    return;
    #endif
    gl_FragColor = vec4(lit * (1.0 - 1.1 * across * across) + ground, 1.0);
  }`;

// Smoothing edges by several samples of a pixel is free on a GPU and more than doubles the time of a
// frame where a CPU draws.
function drawnByCpu() {
  const context = document.createElement("canvas").getContext("webgl");
  const names = context?.getExtension("WEBGL_debug_renderer_info");
  const renderer = names ? context.getParameter(names.UNMASKED_RENDERER_WEBGL) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(renderer);
}

/** Draws on the canvas. Throws if there is no WebGL. */
export class NeedleScene {
  constructor(canvas, frames) {
    const { length, share_of_length: shares, diameter, share_of_diameter: widths } = frames;
    this.shares = shares && numbers(shares);
    this.widths = widths && numbers(widths);
    this.haveWidth = diameter !== undefined;
    this.length = length;
    this.width = diameter ?? 0.035 * length;
    this.renderer = new three.WebGLRenderer({ canvas, antialias: !drawnByCpu(), powerPreference: "low-power" });
    this.camera = new three.PerspectiveCamera(35, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enablePan = false;
    this.controls.addEventListener("change", () => this.draw());
    this.scene = new three.Scene();
    this.uniforms = {
      box: { value: new three.Vector3(1, 1, 1) },
      needleLength: { value: length },
      range: { value: new three.Vector2(0, 1) },
      pixel: { value: 0 },
      lens: { value: new three.Vector2() },
      width: { value: this.width },
      depth: { value: new three.Vector2(0, 1) },
      palette: { value: null },
      background: { value: new three.Color() },
      neutral: { value: new three.Color(0x888888) },
    };
    this.geometry = new three.BufferGeometry();
    this.count = 0;
    const material = new three.ShaderMaterial({
      uniforms: this.uniforms, vertexShader, fragmentShader, side: three.DoubleSide, defines: this.haveWidth ? { RODS: 1 } : {},
    });
    this.needles = new three.Mesh(this.geometry, material);
    this.needles.frustumCulled = false;
    this.box = new three.LineSegments(edgesWithout(openSides(frames)), new three.LineBasicMaterial());
    this.walls = frames.walls.map((wall) => new Wall(wall));
    this.lookAtBox();
    this.scene.add(this.needles, this.box, ...this.walls.flatMap(({ parts }) => parts));
  }

  /** What is drawn lies between the corners `low` and `high`, its middle in the origin. Arrays of a
   * frame: `position` between the corners in units of 1 / 65536, `orientation` in units of 1 / 32767;
   * `walls`: the place of each along its axis; `scale`: the sizes of bodies that grow. */
  showFrame({ low, high, walls, position, orientation, scale = 1 }) {
    const box = high.map((end, axis) => end - low[axis]);
    const sameBox = this.box.scale.equals(new three.Vector3(...box));
    this.walls.forEach((wall, n) => wall.place(walls[n], low, high));
    this.uniforms.box.value.set(...box);
    this.uniforms.needleLength.value = scale * this.length;
    this.uniforms.width.value = scale * this.width;
    this.box.scale.set(...box);
    this.setCount(position.length / 3);
    this.setAttribute("centre", position, 3, true);
    this.setAttribute("orientation", orientation, 3, true);
    if (!sameBox) this.keepInView();
  }

  // Frames of one file have the same number of needles, so that this is done once.
  setCount(count) {
    if (count === this.count) return;
    this.count = count;
    this.geometry.dispose();
    this.geometry.setAttribute("corner", new three.BufferAttribute(repeated([-0.5, -0.5, 0.5, -0.5, 0.5, 0.5, -0.5, 0.5], count), 2));
    const corners = [0, 1, 2, 0, 2, 3];
    const index = Uint32Array.from({ length: 6 * count }, (_, n) => 4 * Math.floor(n / 6) + corners[n % 6]);
    this.geometry.setIndex(new three.BufferAttribute(index, 1));
    this.setAttribute("shareOfLength", this.shares ?? new Float32Array(count).fill(1), 1, false);
    if (this.haveWidth) this.setAttribute("shareOfDiameter", this.widths ?? new Float32Array(count).fill(1), 1, false);
  }

  // Gives the corners of each needle its numbers, in the array of the frame before where there is one.
  setAttribute(name, values, size, normalized) {
    const before = this.geometry.getAttribute(name);
    const fits = before?.array.length === 4 * values.length;
    const array = fits ? before.array : new values.constructor(4 * values.length);
    for (let n = 0; n < values.length; n += size) {
      const one = values.subarray(n, n + size);
      for (let corner = 0; corner < 4; ++corner) array.set(one, 4 * n + corner * size);
    }
    if (fits) before.needsUpdate = true;
    else this.geometry.setAttribute(name, new three.BufferAttribute(array, size, normalized));
  }

  /** A number for each needle, coloured from the first to the second of `range`. */
  showColours(values, range) {
    this.setAttribute("value", values, 1, false);
    this.uniforms.range.value.set(...range);
  }

  /** `colours`: 256 texts in CSS. */
  showPalette(colours, background, line) {
    const bytes = new Uint8Array(4 * colours.length);
    const colour = new three.Color();
    colours.forEach((text, n) => {
      colour.setStyle(text, three.LinearSRGBColorSpace); // as they are, for no lights are computed
      bytes.set([colour.r, colour.g, colour.b, 1].map((part) => Math.round(255 * part)), 4 * n);
    });
    this.uniforms.palette.value?.dispose();
    const texture = new three.DataTexture(bytes, colours.length, 1);
    texture.magFilter = three.LinearFilter;
    texture.needsUpdate = true;
    this.uniforms.palette.value = texture;
    this.uniforms.background.value.setStyle(background, three.LinearSRGBColorSpace);
    this.scene.background = new three.Color().setStyle(background);
    this.box.material.color.setStyle(line);
  }

  /** `colourOf(kind)`: of walls of a kind, in CSS. */
  showWallColours(colourOf) {
    for (const wall of this.walls) wall.colour(colourOf(wall.kind));
  }

  /** Puts the camera where the whole box is seen. */
  lookAtBox() {
    this.camera.position.set(0.62, -0.68, 0.4);
    this.distance = this.camera.position.length();
    this.keepInView();
  }

  // In the direction in which the reader looks, and as near, in units of the box.
  keepInView() {
    const before = this.distance;
    const size = this.box.scale.length();
    this.distance = (0.54 * size) / Math.tan((this.camera.fov * Math.PI) / 360) / Math.min(1, this.camera.aspect);
    this.camera.position.multiplyScalar(this.distance / before);
    this.camera.near = 0.01 * this.distance;
    this.camera.far = 4 * this.distance;
    this.controls.minDistance = 0.1 * this.distance;
    this.controls.maxDistance = 2 * this.distance;
    this.controls.target.set(0, 0, 0);
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  /** Turns about the vertical axis and towards the pole by these angles, in radians. */
  turn(about, towards) {
    const place = new three.Spherical().setFromVector3(this.camera.position.clone().applyAxisAngle(new three.Vector3(1, 0, 0), -Math.PI / 2));
    place.theta += about;
    place.phi = Math.min(Math.max(place.phi + towards, 0.05), Math.PI - 0.05);
    this.camera.position.setFromSpherical(place).applyAxisAngle(new three.Vector3(1, 0, 0), Math.PI / 2);
    this.controls.update();
  }

  /** Multiplies the distance of the viewer. */
  zoom(factor) {
    const { minDistance, maxDistance } = this.controls;
    const distance = Math.min(Math.max(this.camera.position.length() * factor, minDistance), maxDistance);
    this.camera.position.setLength(distance);
    this.controls.update();
  }

  resize(width, height) {
    const aspect = width / height;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    const before = this.camera.aspect;
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
    if (Math.min(1, before) !== Math.min(1, aspect)) this.keepInView();
  }

  draw() {
    const height = this.renderer.domElement.height;
    this.uniforms.pixel.value = (2 * Math.tan((this.camera.fov * Math.PI) / 360)) / height;
    const { elements } = this.camera.projectionMatrix;
    this.uniforms.lens.value.set(elements[10], elements[14]);
    const distance = this.camera.position.length();
    const half = 0.5 * this.box.scale.length();
    this.uniforms.depth.value.set(distance - half, distance + half);
    this.renderer.render(this.scene, this.camera);
  }

  /** What the last frame was drawn with. */
  get statistics() {
    const { calls } = this.renderer.info.render;
    return { drawCalls: calls, needles: this.count };
  }
}

// The edges of a cube of side 1 around the origin, without those of these sides.
function edgesWithout(sides) {
  const ends = [];
  for (let axis = 0; axis < 3; ++axis) {
    const others = [0, 1, 2].filter((other) => other !== axis);
    for (const [a, b] of [[0, 0], [0, 1], [1, 0], [1, 1]]) {
      const highs = { [others[0]]: a === 1, [others[1]]: b === 1 };
      if (sides.some((side) => highs[side.axis] === side.high)) continue;
      for (const along of [-0.5, 0.5]) {
        const point = [0, 0, 0];
        point[axis] = along;
        for (const other of others) point[other] = highs[other] ? 0.5 : -0.5;
        ends.push(...point);
      }
    }
  }
  return new three.BufferGeometry().setAttribute("position", new three.Float32BufferAttribute(ends, 3));
}

function repeated(numbers, count) {
  return Float32Array.from({ length: numbers.length * count }, (_, n) => numbers[n % numbers.length]);
}
