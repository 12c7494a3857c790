// What readers of a page can do, each in a browser of their own kind.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { cleanUp, launch, needlework, open, readPage, write } from "./browser.js";

const observables = [
  "fields", "profiles", "flow_order", "distributions", "alignment", "velocity_moments",
  "temperature_by_axis", "pair_correlation", "structure_factor", "displacement", "time_correlation", "collision_statistics",
];
let browser;
let samples;

// Runs the scene, which names its file, and makes a page of it.
function reportOf(name, scene) {
  write(`${name}.toml`, scene);
  needlework("run", `${name}.toml`, "--quiet");
  needlework("report", `${name}.h5`, "-o", `${name}.html`);
}

before(async () => {
  write("gas.toml", `title = "A gas </script> & more"
needles = { count = 300, box = 7 }
initial.t_rot = 0
collisions = { epsilon = 0.8, tc_relative = 1e-3 }
until.energy_ratio = 0.1
output = { file = "gas.h5", frames = 3, observables = ${JSON.stringify(observables)} }
`);
  needlework("run", "gas.toml", "--quiet");
  needlework("run", "gas.toml", "--quiet", "--out", "other.h5", "--set", "collisions.epsilon=0.9");
  write("grid.toml", `scene = "gas.toml"
seeds = [1, 2]
out = "sweep"
[parameters]
"collisions.epsilon" = [0.7, 0.8, 0.9]
"needles.count" = 100
"output.observables" = [[]]
"output.frames" = 1
`);
  needlework("sweep", "grid.toml", "--quiet");
  write("bench.json", JSON.stringify({
    machine: "a machine",
    cases: [1, 2, 4].flatMap((n) => ["capsules", "linked-cells"].map((search) => ({ name: `n=${n},N=10/${search}/auto`, us_per_collision: [n, 2 * n] }))),
  }));
  reportOf("shaken", `title = "Shaken"
needles = { count = 60, box = [5, 5, 3] }
forces.gravity = [0, 0, -1]
collisions = { epsilon = 0.9, tc_relative = 1e-3 }
until.time = 20
output = { file = "shaken.h5", series_every = 0.45, frames = [0.25, 0.75], observables = ["wall_profiles", "centre_of_mass"] }
driving.kicks = { every = 0.7, translational = 0.3, rotational = 0.3 }
walls = [{ axis = "z", side = "low", epsilon = 0.95, motion = { amplitude = 0.5, frequency = 1 } }]
`);
  write("shaken_grid.toml", `scene = "shaken.toml"
seeds = [1, 2]
out = "shaken"
[parameters]
"walls.z-low.epsilon" = [0.9, 0.95]
"until.time" = 2
`);
  needlework("sweep", "shaken_grid.toml", "--quiet");
  needlework("report", "shaken/summary.h5", "-o", "shaken_sweep.html");
  reportOf("layer", `needles = { count = 60, box = [5, 5, 30] }
forces.gravity = [0, 0, -1]
collisions = { epsilon = 0.9, tc_relative = 1e-3 }
until.time = 40
output = { file = "layer.h5", series_every = 1, frames = [0.0, 20.0, 40.0], observables = ["wall_profiles"] }
walls = [{ axis = "z", side = "low", temperature = 0.5 }]
`);
  reportOf("between", `needles = { count = 60, box = [5, 5, 3] }
until.time = 2
output.file = "between.h5"
walls = [{ axis = "x", side = "both", temperature = 2 }, { axis = "z", side = "low" }, { axis = "z", side = "high" }]
`);
  for (const [name, length, diameter] of [["rod", 3, 0.5], ["ball", 0, 0.5], ["wide", 0, 1]]) {
    reportOf(name, `needles.box = 8
until.time = 1
output.file = "${name}.h5"
species = [{ name = "${name}", count = 1, length = ${length}, diameter = ${diameter} }]
`);
  }
  reportOf("sliding", `needles = { count = 80, box = 4 }
collisions = { epsilon = 0.3, sliding = true }
until.time = 1
output = { file = "sliding.h5", series_every = 0.125, observables = ["time_correlation"] }
`);
  reportOf("growing", `needles.box = 6
driving.growth = { rate = 0.1, until_packing = 0.3 }
until.collisions_per_needle = 1000
output = { file = "growing.h5", observables = ["contact_network"] }
species = [{ name = "balls", count = 60, length = 0, diameter = 0.4 }]
`);
  write("growing_grid.toml", `scene = "growing.toml"
seeds = [1, 2]
out = "growing"
[parameters]
"driving.growth.rate" = [0.1, 0.2]
"until.collisions_per_needle" = 5
`);
  needlework("sweep", "growing_grid.toml", "--quiet");
  needlework("report", "growing/summary.h5", "-o", "growing_sweep.html");
  reportOf("sheared", `needles.box = 6
shear.rate = 0.5
collisions = { epsilon = 0.8, tc_relative = 1e-3 }
until.time = 5
output = { file = "sheared.h5", series_every = 0.5, observables = ["distributions"] }
species = [{ name = "balls", count = 60, length = 0, diameter = 0.8 }]
`);
  reportOf("posts", `needles.box = 6
until.time = 3
output = { file = "posts.h5", series_every = 0.5, observables = ["distributions"] }
species = [
  { name = "balls", count = 60, length = 0, diameter = 0.5 },
  { name = "rods", count = 60 },
  { name = "posts", count = 20, length = 0, diameter = 0.8, fixed = true },
]
pairs = [{ between = ["balls", "balls"], beta = 0.5 }]
`);
  needlework("report", "gas.h5", "-o", "gas.html");
  needlework("report", "gas.h5", "other.h5", "sweep/summary.h5", "bench.json", "-o", "all.html");
  samples = Number(needlework("info", "gas.h5").match(/(\d+) samples/)[1]);
  browser = await launch();
});

after(async () => {
  await browser?.close();
  cleanUp();
});

// A test of a page, opened in a browser of its own kind and closed after it.
const show = (claim, page, look) => test(claim, async () => {
  const { close, ...opened } = await open(browser, ...page);
  await look(opened);
  await close();
});

const chart = (page, title) => page.locator("figure.chart", { has: page.getByRole("heading", { name: title, exact: true }) });
const view = (page) => chart(page, "Needles");

async function drawn(page) {
  await view(page).scrollIntoViewIfNeeded();
  await page.waitForFunction(() => [...document.querySelectorAll("figure")].find((f) => f.view)?.view.scene?.statistics.drawCalls > 0);
  return view(page).evaluate((figure) => figure.view.statistics);
}

// How many different colours a grid of pixels has just after drawing, before they may be cleared.
function colours(page) {
  return view(page).evaluate((figure) => {
    const { scene } = figure.view;
    scene.draw();
    const gl = scene.renderer.getContext();
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return new Set(new Uint32Array(pixels.buffer)).size;
  });
}

test("a page from disk opens without complaints and without the network", async () => {
  for (const name of ["gas.html", "all.html"]) {
    const { page, complaints, close } = await open(browser, name);
    await drawn(page).catch(() => null);
    assert.deepEqual(complaints, []);
    await close();
  }
});

test("what cannot be shown leaves the rest of the page", async () => {
  const whole = readPage("all.html");
  const mark = /(<script [^>]*id="data">)([^]*?)(<\/script>)/;
  const report = JSON.parse(whole.match(mark)[2]);
  delete report.sections[0].groups.totals.datasets.t_tr;
  delete report.sections[2].members;
  write("broken.html", whole.replace(mark, (_, head, text, end) => head + JSON.stringify(report).replaceAll("</", "<\\/") + end));
  const { page, complaints, close } = await open(browser, "broken.html");
  const failed = await page.locator("[role=alert]").allTextContents();
  assert.equal(failed.length, complaints.length);
  for (const what of ["The comparison", "Results", "Charts over time", "summary.h5"]) {
    assert.ok(failed.some((text) => text.startsWith(`${what} cannot be shown: `)), `${what}: ${failed}`);
  }
  for (const title of ["Pair correlation", "Cooling curve", "Collision rate"]) assert.ok((await chart(page, title).count()) > 0, title);
  await close();
});

show("a title is shown as it is", ["gas.html"], async ({ page }) => {
  assert.equal(await page.locator("h1").textContent(), "A gas </script> & more");
});

show("curves have the points of the file, and so has the table behind them", ["gas.html"], async ({ page }) => {
  const figure = chart(page, "Cooling curve");
  assert.equal(await figure.getAttribute("data-points"), `${samples} ${samples}`);
  assert.equal(await figure.locator("svg [aria-label=dot] circle").count(), samples - 1); // time 0 has no logarithm
  await figure.getByText("Table").click();
  await figure.locator("tbody tr").first().waitFor();
  assert.equal(await figure.locator("tbody tr").count(), samples);
  assert.equal(await figure.locator("caption").textContent(), "Cooling curve");
  assert.equal(await figure.locator("tbody tr").first().locator("td").nth(1).textContent(), "1");
});

show("each observable of the file has its charts", ["gas.html"], async ({ page }) => {
  for (const title of [
    "Ratio of the temperatures", "Order of the flow, S", "Departure from Gaussian velocities", "T_tr by axis", "Nematic order",
    "Mean square displacement", "Repeated collisions", "Needles in a cell", "Alignment with the velocity", "Profile: density",
    "Pair correlation", "Structure factor", "Normal velocity at contact", "Fields",
  ]) {
    assert.equal(await chart(page, title).count(), 1, title);
    assert.ok((await chart(page, title).locator("svg path, svg circle, svg image").count()) > 0, title);
  }
});

test("no observable of the file is without a chart", async () => {
  for (const name of ["gas", "shaken", "sliding", "rod", "growing"]) {
    const { page, complaints, close } = await open(browser, `${name}.html`);
    const groups = await page.evaluate(() => Object.keys(JSON.parse(document.getElementById("data").textContent).sections[0].groups));
    const charted = await page.evaluate(() => [...document.querySelectorAll("figure[data-group]")].map((f) => f.dataset.group));
    assert.deepEqual(groups.filter((group) => !charted.includes(group)), [], name);
    assert.deepEqual(complaints, []);
    await close();
  }
});

// What the table behind a chart says: rows of numbers.
async function tableOf(figure) {
  await figure.getByText("Table").click();
  await figure.locator("tbody tr").first().waitFor();
  return figure.locator("tbody tr").evaluateAll((rows) => rows.map((row) => [...row.cells].map((cell) => Number(cell.textContent.replace("−", "-")))));
}

show("rods have their pressure beside that of an ideal gas", ["rod.html"], async ({ page }) => {
  const last = (await tableOf(chart(page, "Pressure"))).at(-1);
  // A single rod, of the temperature 1 in a box of 8, has no partner.
  for (const pressure of last.slice(-2)) assert.ok(Math.abs(512 * pressure - 1) < 1e-5, `${last}`);
});

test("contacts are shown over time, and correlations in time over the lag", async () => {
  const { page, close } = await open(browser, "sliding.html");
  const share = await tableOf(chart(page, "Time in contact"));
  assert.equal(share.length, 9);
  // The means over each step add up to that since the start.
  const sum = share.slice(1).reduce((total, [, step]) => total + step / 8, 0);
  assert.ok(sum > 0 && Math.abs(sum / share.at(-1)[2] - 1) < 1e-4, `${sum}`); // of six digits
  assert.match(await chart(page, "Contacts").locator(".legend").textContent(), /entered.*ended by force.*ended at a tip.*ended by strikes/);
  for (const title of ["Displacement over time", "Correlation of directors", "Correlation of velocities", "Correlation of angular velocities"]) {
    assert.match(await chart(page, title).locator("figcaption").textContent(), /Mean over the 9 samples/, title);
  }
  const directors = await tableOf(chart(page, "Correlation of directors"));
  const start = directors.findIndex(([lag]) => lag === 0);
  assert.deepEqual(directors[start].slice(1).map((value) => Math.round(1e9 * value)), [1e9, 1e9]);
  assert.deepEqual(directors.slice(0, 9).map(([lag]) => Math.round(1e9 * lag) / 1e9), [0, 1, 2, 3, 4, 5, 6, 7, 8].map((n) => n / 8));
  await close();
  const cooling = await open(browser, "gas.html");
  assert.match(await chart(cooling.page, "Correlation of directors").locator("figcaption").textContent(), /not evenly spaced/);
  await cooling.close();
});

show("pictures of a layer under an open side end where it does", ["layer.html"], async ({ page }) => {
  await drawn(page);
  const seen = await view(page).evaluate((figure) => {
    const { scene, frames } = figure.view;
    return [0, 2].map((n) => {
      figure.view.showFrame(n);
      scene.turn(0.2, 0); // a reader turns it
      return { high: frames.frames[n].high[2], box: scene.box.scale.z, camera: scene.camera.position.toArray() };
    });
  });
  assert.ok(seen[0].high > 25 && seen[1].high < 12, JSON.stringify(seen));
  assert.ok(Math.abs(seen[1].box - seen[1].high) < 1e-9);
  const length = seen.map(({ camera }) => Math.hypot(...camera));
  assert.ok(length[1] < 0.6 * length[0], `${length}`);
  // Another frame does not turn it back.
  const azimuth = seen.map(({ camera: [x, y] }) => Math.atan2(y, x));
  assert.ok(Math.abs(azimuth[1] - azimuth[0] - 0.2) < 1e-6, `${azimuth}`);
  const density = chart(page, "Between walls: density");
  const ticks = () => density.locator("svg [aria-label='x-axis tick label'] text").allTextContents();
  assert.ok(Math.max(...(await ticks()).map(Number)) <= 12, `${await ticks()}`);
  // At the start needles fill the box.
  await page.getByLabel("Time of the charts below").fill("0");
  assert.ok(Math.max(...(await ticks()).map(Number)) >= 20, `${await ticks()}`);
  assert.match(await density.locator("figcaption").textContent(), /the axis ends with the needles/);
});

show("all needles are drawn in one draw call, beside that of the box", ["gas.html"], async ({ page }) => {
  const { needles, drawCalls } = await drawn(page);
  assert.equal(needles, 300);
  assert.equal(drawCalls, 2);
  assert.ok((await colours(page)) > 50);
});

show("walls are drawn where they are, and what bounds the box is said", ["shaken.html"], async ({ page, complaints }) => {
  const { drawCalls } = await drawn(page);
  assert.equal(drawCalls, 4); // needles, box, sheet and lattice
  const heights = await view(page).evaluate((figure) => [0, 1, 2].map((n) => {
    figure.view.showFrame(n);
    const { low, high } = figure.view.frames.frames[n];
    return figure.view.scene.walls[0].sheet.position.z + (low[2] + high[2]) / 2;
  }));
  [0, 0.5, -0.5].forEach((height, n) => assert.ok(Math.abs(heights[n] - height) < 1e-9, `${heights}`));
  const caption = await view(page).locator("figcaption").textContent();
  assert.match(caption, /periodic along x and y, with a moving wall at z low, open at z high/);
  assert.match(await view(page).locator("canvas").getAttribute("aria-label"), /60 needles in a box that is periodic along x and y/);
  // The edges of the open side are left out: 8 of 12.
  assert.equal(await view(page).evaluate((figure) => figure.view.scene.box.geometry.getAttribute("position").count), 16);
  assert.deepEqual(complaints, []);
});

// How many pixels a single rod covers, and the largest number in a row or column of them.
function covered(page) {
  return view(page).evaluate((figure) => {
    const { scene } = figure.view;
    scene.box.visible = false;
    scene.draw();
    const gl = scene.renderer.getContext();
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const pixels = new Uint32Array(width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(pixels.buffer));
    const rows = new Float64Array(height);
    const columns = new Float64Array(width);
    pixels.forEach((pixel, n) => {
      if (pixel === pixels[0]) return;
      rows[Math.floor(n / width)] += 1;
      columns[n % width] += 1;
    });
    const count = rows.reduce((sum, value) => sum + value, 0);
    return { count, wide: Math.max(...rows), high: Math.max(...columns) };
  });
}

test("rods and spheres are as wide as they are", async () => {
  const areas = {};
  for (const name of ["rod", "ball", "wide"]) {
    const { page, complaints, close } = await open(browser, `${name}.html`);
    await drawn(page);
    areas[name] = await covered(page);
    const facts = await page.locator("dl.facts").textContent();
    assert.match(facts, name === "rod" ? /Length, diameter, mass3, 0.5, 1/ : /Length, diameter, mass0, /);
    assert.match(facts, /Packing fraction/);
    assert.deepEqual(complaints, []);
    await close();
  }
  // A ball is a disc.
  const { count, wide, high } = areas.wide;
  assert.ok(Math.abs(wide - high) < 4 && wide > 20, `${wide} ${high}`);
  assert.ok(Math.abs(count / (Math.PI / 4 * wide * high) - 1) < 0.1, `${count} in ${wide} times ${high}`);
  assert.ok(areas.rod.count > 2 * areas.ball.count, `${areas.rod.count} ${areas.ball.count}`);
  assert.ok(areas.wide.count > 2.5 * areas.ball.count, `${areas.wide.count} ${areas.ball.count}`);
});

show("a ball hides the edges of the box inside and behind it", ["wide.html"], async ({ page }) => {
  await drawn(page);
  // Around the corner that is farthest from the viewer, from which three edges come nearer. They leave
  // the ball in front, where they are 0.8 radii from its middle.
  const { inside, changed } = await view(page).evaluate((figure) => {
    const { scene } = figure.view;
    scene.setAttribute("centre", new Uint16Array([0, 65535, 0]), 3, true);
    const gl = scene.renderer.getContext();
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const drawn = (visible) => {
      scene.box.visible = visible;
      scene.draw();
      const pixels = new Uint32Array(width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(pixels.buffer));
      return pixels;
    };
    const [without, edges] = [drawn(false), drawn(true)];
    const size = scene.box.scale;
    const middle = scene.camera.position.clone().set(-size.x / 2, size.y / 2, -size.z / 2).project(scene.camera);
    const [x, y] = [(0.5 + 0.5 * middle.x) * width, (0.5 + 0.5 * middle.y) * height];
    const radius = Math.sqrt(without.filter((pixel) => pixel !== without[0]).length / Math.PI);
    const out = { inside: 0, changed: 0 };
    without.forEach((pixel, n) => {
      if (pixel === edges[n]) return;
      out.changed += 1;
      if (Math.hypot((n % width) - x, Math.floor(n / width) - y) < 0.7 * radius) out.inside += 1;
    });
    return out;
  });
  assert.ok(changed > 100, `${changed}`);
  assert.equal(inside, 0);
});

show("the place of a needle in the table is that in the box, whatever is drawn", ["shaken.html"], async ({ page }) => {
  await drawn(page);
  const { least, high } = await view(page).evaluate((figure) => {
    const columns = figure.view.columns();
    return { least: Math.min(...columns[2].values), high: figure.view.frames.frames.at(-1).high[2] };
  });
  assert.ok(least > -0.5 && least < high);
  const low = await view(page).evaluate((figure) => {
    figure.view.showFrame(2);
    return [figure.view.frames.frames[2].low[2], Math.min(...figure.view.columns()[2].values)];
  });
  assert.equal(low[0], -0.5);
  assert.ok(low[1] > -0.5);
});

show("contacts and the time that needles spend in them are told", ["sliding.html"], async ({ page }) => {
  const facts = await page.locator(".facts").first().textContent();
  assert.ok(facts.includes("Sliding contactwhere flights are below 0.001 mean free times"), facts);
  assert.ok(!facts.includes("Contact-time rule"), facts);
  const figures = await page.locator(".figures").textContent();
  assert.match(figures, /Contacts: ended by tip\d+Contacts: entered\d+/);
  assert.match(figures, /Contacts: share0\.\d+/);
});

show("hits, forces and what acts on the gas are told", ["shaken.html"], async ({ page }) => {
  const facts = await page.locator(".facts").first().textContent();
  for (const part of ["Boundariesperiodic along x and y", "Wall at z lowε = 0.95, moves by 0.5 sin(2π 1 t)", "Gravity0, 0, −1"]) {
    assert.ok(facts.includes(part), `${part}: ${facts}`);
  }
  assert.ok(!facts.includes("Density"));
  const figures = await page.locator(".figures").textContent();
  assert.match(figures, /Hits at z low[\d\s.]+ [\d.]+ per needle and time/);
  assert.match(figures, /Force at z low[\d.]+ weight: 60/);
  for (const title of ["Hits on walls", "Force on walls"]) assert.equal(await chart(page, title).count(), 1, title);
  const force = chart(page, "Force on walls");
  assert.match(await force.locator(".legend").textContent(), /z low.*weight/);
  assert.match(await chart(page, "Cooling curve").locator("figcaption").textContent(), /that of the weight/);
  const momentum = await chart(page, "Conservation of momentum").locator("figcaption").textContent();
  assert.match(momentum, /along the periodic axes/);
});

show("walls have pressures, profiles with their means, and a budget of energy that closes", ["shaken.html"], async ({ page }) => {
  const legend = (title) => chart(page, title).locator(".legend").textContent();
  assert.match(await legend("Pressure on walls"), /z low.*weight over area/);
  assert.match(await legend("Energy put in and taken out"), /collisions.*kicks.*wall at z low.*change of the energy/);
  assert.match(await legend("Power put in and taken out"), /collisions.*kicks.*wall at z low/);
  const off = (await chart(page, "Energy put in and taken out").locator("figcaption").textContent()).match(/met to ([\d.]+)×10⁻(\S+)\./);
  assert.ok(off && off[2].length === 2, `${off}`); // 1e-10 or less
  assert.match(await legend("Centre of mass"), /z/);
  // Samples are at 20 phases, of which two share a bin four times.
  for (const title of ["Pressure by phase", "Temperatures by phase", "Centre of mass by phase"]) {
    assert.match(await chart(page, title).getAttribute("data-points"), /^16( 16)*$/, title);
  }
  for (const [title, names] of [
    ["Between walls: density", ["along z", "along z, mean of the later half"]],
    ["Between walls: temperatures", ["T_tr z", "T_rot z", "T along the axis z", "T_tr z, mean of the later half"]],
    ["Between walls: flow", ["along z"]],
    ["Between walls: angle to the wall", ["along z", "along z, mean of the later half", "random directors"]],
    ["Between walls: order", ["P₂ along z", "nematic order z", "nematic order z, mean of the later half", "random directors"]],
  ]) {
    assert.equal(await chart(page, title).count(), 1, title);
    const text = await legend(title);
    for (const name of names) assert.ok(text.includes(name), `${title}: ${name}: ${text}`);
    assert.ok((await chart(page, title).locator("svg path").count()) > 0, title);
  }
  // The slabs reach to three heights of the box; what is above them is not in the mean.
  const density = chart(page, "Between walls: density");
  await density.getByText("Table").click();
  await density.locator("tbody tr").first().waitFor();
  const sum = await density.locator("tbody tr").evaluateAll((rows) => rows.reduce((sum, row) => sum + (Number(row.cells[2].textContent) || 0), 0));
  const slabs = await density.locator("tbody tr").count();
  assert.equal(slabs, 76);
  const needles = (sum * 25 * 9.5) / slabs;
  assert.ok(needles > 15 && needles <= 60, `${needles}`);
});

test("what growth and shear give is in the budget of energy, which closes", async () => {
  for (const [name, sources] of [["growing", /collisions.*cooling.*growth.*change/], ["sheared", /collisions.*shear.*change/]]) {
    const { page, close } = await open(browser, `${name}.html`);
    const put = chart(page, "Energy put in and taken out");
    assert.match(await put.locator(".legend").textContent(), sources);
    assert.match(await put.locator("figcaption").textContent(), /met to [\d.]+×10⁻¹\S\./, name);
    await close();
  }
});

show("a sweep of bodies that grow has the budget and the numbers of growth", ["growing_sweep.html"], async ({ page, complaints }) => {
  for (const title of [
    "Energy put in: collisions", "Energy put in: growth", "Energy put in: cooling", "Growth: packing fraction", "Growth: pressure",
    "Network: contacts", "Network: rattlers",
  ]) {
    assert.equal(await chart(page, title).count(), 1, title);
  }
  assert.equal(await chart(page, "Ratios of the temperatures").count(), 0);
  assert.deepEqual(complaints, []);
});

show("smooth spheres have no ratio of temperatures and no energy of rotation", ["sheared.html"], async ({ page }) => {
  for (const title of ["Ratio of the temperatures", "Energy of rotation"]) assert.equal(await chart(page, title).count(), 0, title);
  assert.doesNotMatch(await page.locator(".figures").textContent(), /∞|Infinity|T_tr\/T_rot/);
  assert.match(await page.locator(".facts").first().textContent(), /Shearrate 0.5/);
  assert.equal(await chart(page, "Conservation of momentum").count(), 1);
});

show("energy of rotation is compared with as many Gaussian components as bodies have", ["posts.html"], async ({ page }) => {
  for (const [name, density] of [["balls", (e) => 2 * Math.sqrt(e / Math.PI) * Math.exp(-e)], ["rods", (e) => Math.exp(-e)]]) {
    const rows = await tableOf(chart(page, `Energy of rotation: ${name}`));
    const near = rows.filter(([e]) => e > 0.5 && e < 3);
    assert.ok(near.length > 20);
    for (const row of near) assert.ok(Math.abs(row.at(-1) / density(row[0]) - 1) < 1e-2, `${name}: ${row}`);
  }
});

show("fixed bodies take up momentum, which is then not conserved", ["posts.html"], async ({ page, complaints }) => {
  assert.equal(await chart(page, "Conservation of momentum").count(), 0);
  assert.match(await page.locator(".facts").first().textContent(), /Species balls[^:]*: [^:]*T_rot 1.*Species posts/);
  assert.deepEqual(complaints, []);
});

show("a sweep has pressures, hits and the budget of its members", ["shaken_sweep.html"], async ({ page, complaints }) => {
  for (const title of [
    "Hits on the wall at z low", "Pressure on the wall at z low", "Energy put in: wall at z low", "Energy put in: collisions",
    "Energy put in: kicks",
  ]) {
    assert.equal(await chart(page, title).count(), 1, title);
    assert.equal(await chart(page, title).getAttribute("data-points"), "2", title);
  }
  assert.deepEqual(complaints, []);
});

show("walls on two axes are four, and nothing is open", ["between.html"], async ({ page }) => {
  assert.equal((await drawn(page)).drawCalls, 10);
  const facts = await page.locator(".facts").first().textContent();
  assert.ok(facts.includes("periodic along y, with a thermal wall at x low, a thermal wall at x high, a wall at z low and a wall at z high"), facts);
  assert.ok(facts.includes("Wall at x lowtemperature 2"));
  assert.equal(await chart(page, "Temperatures by phase").count(), 0); // no wall moves
  assert.ok(facts.includes("Density"));
  assert.equal(await chart(page, "Hits on walls").getAttribute("data-points").then((points) => points.split(" ").length), 4);
});

show("a periodic box is called so", ["gas.html"], async ({ page }) => {
  assert.match(await view(page).locator("figcaption").textContent(), /Drawn in the box, which is periodic, at the places/);
});

show("every colouring changes the picture", ["gas.html"], async ({ page }) => {
  await drawn(page);
  const picture = () => view(page).evaluate((figure) => {
    figure.view.scene.draw();
    return figure.view.canvas.toDataURL();
  });
  const pictures = [];
  for (const key of ["speed", "spin", "flow", "alignment", "density"]) {
    await view(page).getByLabel("Colour by").selectOption(key);
    pictures.push(await picture());
  }
  assert.equal(new Set(pictures).size, 5);
});

show("a film shows the flow in colours of two directions, which stay the same", ["gas.html"], async ({ page }) => {
  await drawn(page);
  await view(page).getByLabel("Colour by").selectOption("flow");
  const shown = () => view(page).evaluate((figure) => ({
    bar: figure.view.bar.textContent,
    colours: figure.view.bar.querySelector(".gradient").style.background,
    middle: [...figure.view.scene.uniforms.palette.value.image.data.slice(4 * 128, 4 * 128 + 3)],
    ends: [0, 255].map((n) => [...figure.view.scene.uniforms.palette.value.image.data.slice(4 * n, 4 * n + 3)]),
    values: [...figure.view.valuesOf("flow")],
    frame: figure.view.current,
  }));
  const last = await shown();
  assert.match(last.bar, /^flow along [xyz] \(\(T_tr \/ m\)\^½\)−1.51.5$/);
  const [[red1, , blue1], [red2, , blue2]] = last.ends;
  assert.ok(blue1 > red1 && red2 > blue2, last.ends.join(" "));
  assert.ok(Math.max(...last.middle) - Math.min(...last.middle) < 20, last.middle.join(" "));
  await view(page).getByRole("button", { name: "Previous frame" }).click();
  const before = await shown();
  assert.equal(before.frame, last.frame - 1);
  assert.equal(before.bar, last.bar);
  assert.equal(before.colours, last.colours);
  assert.notDeepEqual(before.values, last.values);
});

show("frames play and stop", ["gas.html"], async ({ page }) => {
  const { frame } = await drawn(page);
  await view(page).getByRole("button", { name: "Play" }).click();
  await page.waitForFunction((first) => [...document.querySelectorAll("figure")].find((f) => f.view).view.current !== first, frame);
  await view(page).getByRole("button", { name: "Pause" }).click();
  const now = await view(page).evaluate((figure) => figure.view.current);
  await page.waitForTimeout(400);
  assert.equal(await view(page).evaluate((figure) => figure.view.current), now);
});

show("the keyboard turns, zooms, steps and plays", ["gas.html"], async ({ page }) => {
  const { frame } = await drawn(page);
  const camera = () => view(page).evaluate((figure) => figure.view.scene.camera.position.toArray());
  const length = (v) => Math.hypot(...v);
  await view(page).locator("canvas").focus();
  const start = await camera();
  await page.keyboard.press("ArrowLeft");
  const turned = await camera();
  assert.ok(Math.abs(turned[0] - start[0]) > 1e-3);
  assert.ok(Math.abs(length(turned) - length(start)) < 1e-6);
  await page.keyboard.press("ArrowUp");
  assert.ok((await camera())[2] > turned[2]);
  await page.keyboard.press("+");
  assert.ok(length(await camera()) < length(start));
  await page.keyboard.press("Home");
  assert.ok(Math.abs((await camera())[0] - start[0]) < 1e-6);
  await page.keyboard.press(",");
  assert.equal(await view(page).evaluate((figure) => figure.view.current), frame - 1);
  assert.match(await view(page).locator("[aria-live]").first().textContent(), /Frame \d+, time/);
  await page.keyboard.press("Space");
  assert.equal(await view(page).getByRole("button", { name: "Pause" }).count(), 1);
});

show("the mouse turns the needles", ["gas.html"], async ({ page }) => {
  await drawn(page);
  const camera = () => view(page).evaluate((figure) => figure.view.scene.camera.position.toArray());
  const start = await camera();
  const box = await view(page).locator("canvas").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 60, box.y + box.height / 2, { steps: 4 });
  await page.mouse.up();
  assert.notDeepEqual(await camera(), start);
});

show("arrow keys read a chart aloud", ["gas.html"], async ({ page }) => {
  const area = chart(page, "Temperatures").locator(".plot");
  await area.focus();
  await page.keyboard.press("End");
  const spoken = await area.locator("[aria-live]").textContent();
  assert.match(spoken, /^time [\d.]+: T_tr [\d.]+; T_tr, theory [\d.]+; T_rot [\d.]+; T_rot, theory [\d.]+$/);
  await page.keyboard.press("ArrowLeft");
  assert.notEqual(await area.locator("[aria-live]").textContent(), spoken);
  assert.equal(await area.locator("svg .reading").count(), 1);
});

show("the slider moves histograms and fields through time", ["gas.html"], async ({ page }) => {
  const shape = () => chart(page, "Pair correlation").locator("svg [aria-label=line] path").first().getAttribute("d");
  const image = () => chart(page, "Fields").locator("svg image").first().getAttribute("href");
  const [curve, field] = [await shape(), await image()];
  await page.getByLabel("Time of the charts below").fill("0");
  assert.notEqual(await shape(), curve);
  assert.notEqual(await image(), field);
});

show("logarithmic axes can be switched", ["gas.html"], async ({ page }) => {
  const figure = chart(page, "Cooling curve");
  const before = await figure.locator("svg").textContent();
  const button = figure.getByRole("button", { name: "Cooling curve: logarithmic y axis" });
  const pressed = await button.getAttribute("aria-pressed");
  await button.click();
  assert.notEqual(await button.getAttribute("aria-pressed"), pressed);
  assert.notEqual(await figure.locator("svg").textContent(), before);
});

show("everything that can be used has a name", ["all.html"], async ({ page }) => {
  const nameless = await page.evaluate(() => {
    const named = (e) =>
      e.getAttribute("aria-label") || e.labels?.[0]?.textContent.trim() || e.textContent.trim() ||
      (e.getAttribute("aria-labelledby") && document.getElementById(e.getAttribute("aria-labelledby"))?.textContent.trim());
    return [...document.querySelectorAll("button, a, input, select, canvas, figure, section, nav, [tabindex='0'], [role=img], [role=application], [role=region]")]
      .filter((e) => !named(e) && e.id !== "content").map((e) => e.outerHTML.slice(0, 120));
  });
  assert.deepEqual(nameless, []);
  const ids = await page.evaluate(() => [...document.querySelectorAll("[id]")].map((e) => e.id));
  assert.equal(new Set(ids).size, ids.length);
});

show("no level of headings is left out", ["all.html"], async ({ page }) => {
  const levels = await page.locator("main h2, main h3, main h4").evaluateAll((all) => all.map((h) => Number(h.tagName[1])));
  assert.ok(levels.length > 20);
  levels.forEach((level, n) => assert.ok(n === 0 || level <= levels[n - 1] + 1, `heading ${n}: ${levels.slice(0, n + 1)}`));
});

test("texts can be read in both themes", async () => {
  for (const colorScheme of ["light", "dark"]) {
    const { page, close } = await open(browser, "gas.html", { colorScheme });
    const ratios = await page.evaluate(() => {
      const parse = (text) => text.match(/[\d.]+/g).slice(0, 3).map((part) => {
        const share = part / 255;
        return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
      });
      const light = (text) => parse(text).reduce((sum, part, n) => sum + part * [0.2126, 0.7152, 0.0722][n], 0);
      const groundOf = (e) => {
        for (; e; e = e.parentElement) {
          const { backgroundColor } = getComputedStyle(e);
          if (!/(, 0\)|transparent)$/.test(backgroundColor)) return backgroundColor;
        }
        return "rgb(255, 255, 255)";
      };
      return ["h1", ".source", ".facts dt", "figcaption", "button", "summary", ".legend li", ".keys"].map((selector) => {
        const e = document.querySelector(selector);
        const [a, b] = [light(getComputedStyle(e).color), light(groundOf(e))].sort((x, y) => y - x);
        return [selector, (a + 0.05) / (b + 0.05)];
      });
    });
    for (const [selector, ratio] of ratios) assert.ok(ratio >= 4.5, `${colorScheme} ${selector}: ${ratio}`);
    await close();
  }
});

show("the theme can be chosen, and the needles follow", ["gas.html", { colorScheme: "light" }], async ({ page }) => {
  await drawn(page);
  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const stage = () => view(page).evaluate((figure) => figure.view.scene.scene.background.getHexString());
  const before = [await ground(), await stage()];
  await page.getByLabel("Colours").selectOption("dark");
  assert.notEqual(await ground(), before[0]);
  assert.notEqual(await stage(), before[1]);
});

test("nothing is wider than a telephone or lost on a large screen", async () => {
  for (const width of [360, 1600]) {
    for (const name of ["gas.html", "all.html"]) {
      const { page, close } = await open(browser, name, { viewport: { width, height: 800 } });
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width, name);
      await close();
    }
  }
});

show("a row of results that is not full ends in nothing", ["gas.html", { viewport: { width: 900, height: 700 } }], async ({ page }) => {
  const { last, right, colours } = await page.evaluate(() => {
    const grid = document.querySelector(".figures"), cell = grid.lastElementChild;
    const border = getComputedStyle(grid).borderTopColor;
    return {
      last: cell.getBoundingClientRect().right,
      right: grid.getBoundingClientRect().right,
      colours: { behind: getComputedStyle(grid).backgroundColor, border },
    };
  });
  assert.ok(last < right - 100, `the last row is full: ${last} of ${right}`);
  assert.notEqual(colours.behind, colours.border);
});

show("nothing moves by itself, and slowly for those who asked for that", ["gas.html", { reducedMotion: "reduce" }], async ({ page }) => {
  const { frame } = await drawn(page);
  await page.waitForTimeout(300);
  assert.equal((await drawn(page)).frame, frame);
  await view(page).getByRole("button", { name: "Play" }).click();
  await page.waitForTimeout(500); // a second passes before the first step
  assert.equal(await view(page).evaluate((figure) => figure.view.current), frame);
});

test("without WebGL a text stands in place of the needles, and their table stays", async () => {
  const withoutWebGL = () => {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind.startsWith("webgl") ? null : original.call(this, kind, ...rest);
    };
  };
  const { page, close } = await open(browser, "gas.html", {}, withoutWebGL);
  await page.waitForSelector(".missing");
  await view(page).getByText("Table", { exact: true }).click();
  await view(page).locator("tbody tr").first().waitFor();
  assert.equal(await view(page).locator("tbody tr").count(), 200);
  assert.match(await view(page).locator(".table .tools").textContent(), /Rows 1 to 200 of 300/);
  await page.getByRole("button", { name: "Next rows" }).click();
  assert.equal(await view(page).locator("tbody tr").count(), 100);
  await close();
});

show("a page prints with its needles, in light colours", ["gas.html", { colorScheme: "dark" }], async ({ page }) => {
  await drawn(page);
  const pdf = await page.pdf({ format: "A4", printBackground: true });
  assert.ok(pdf.length > 50000);
  assert.match(await view(page).locator("img.printed").getAttribute("src"), /^data:image\/png/);
});

show("runs, sweeps and benchmarks stand in one page", ["all.html"], async ({ page }) => {
  assert.deepEqual(await page.locator("nav a").count(), 5); // Runs compared, and the four files
  const compared = page.locator("#compared figure", { has: page.getByRole("heading", { name: "Cooling curves" }) });
  assert.equal((await compared.getAttribute("data-points")).split(" ").length, 2);
  const rate = chart(page, "Collision rate").last();
  assert.equal(await rate.getAttribute("data-points"), "3");
  const bench = page.locator("section").last().locator("figure");
  assert.equal(await bench.getAttribute("data-points"), "3 3");
});

// Not judged, as it is the machine's: 20000 needles at 800 x 600, drawn by the CPU.
test("the time of a frame of 20000 needles is measured", async (t) => {
  needlework("run", "gas.toml", "--quiet", "--out", "large.h5", "--set", "needles.count=20000", "--set", "needles.box=12",
    "--set", "until.collisions_per_needle=0.01", "--set", "output.observables=[]", "--set", "output.frames=1");
  needlework("report", "large.h5", "-o", "large.html");
  const { page, close } = await open(browser, "large.html");
  await view(page).evaluate((figure) => {
    const stage = figure.querySelector(".stage");
    Object.assign(stage.style, { width: "800px", height: "600px", maxHeight: "none", aspectRatio: "auto" });
  });
  assert.equal((await drawn(page)).needles, 20000);
  const median = await view(page).evaluate((figure) => {
    const { scene } = figure.view;
    const gl = scene.renderer.getContext();
    const pixel = new Uint8Array(4);
    const times = Array.from({ length: 21 }, () => {
      const start = performance.now();
      scene.turn(0.05, 0);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits until it is drawn
      return performance.now() - start;
    });
    return times.sort((a, b) => a - b)[10];
  });
  t.diagnostic(`median of 21 frames: ${median.toFixed(1)} ms`);
  assert.equal((await drawn(page)).drawCalls, 2);
  await close();
});
