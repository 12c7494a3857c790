// What ends the box: its periodic sides, walls and open sides, in words.

const axes = ["x", "y", "z"];

/** "z low", as sides are named. */
export function sideName({ axis, high }) {
  return `${axes[axis] ?? axis} ${high ? "high" : "low"}`;
}

/** "a", "a and b", "a, b and c" */
function listed(words) {
  return words.length < 2 ? words.join("") : `${words.slice(0, -1).join(", ")} and ${words.at(-1)}`;
}

/** Sides that have no wall although the other end of their axis has one: { axis, high }. */
export function openSides({ walls }) {
  return walls
    .map(({ axis, high }) => ({ axis, high: !high }))
    .filter((side) => !walls.some(({ axis, high }) => axis === side.axis && high === side.high));
}

/** "periodic along x and y, with a moving wall at z low, open at z high". `frames`: what the report
 * holds of the frames of a run. */
export function boundaryText(frames) {
  const { periodic, walls } = frames;
  const along = axes.filter((_, n) => periodic[n]);
  const others = axes.filter((_, n) => !periodic[n] && !walls.some(({ axis }) => axis === n));
  const parts = [along.length === 3 ? "periodic" : along.length ? `periodic along ${listed(along)}` : "not periodic"];
  if (walls.length) parts.push(`with ${listed(walls.map((wall) => `a ${wall.kind} at ${sideName(wall)}`))}`);
  const open = openSides(frames);
  if (open.length) parts.push(`open at ${listed(open.map(sideName))}`);
  if (others.length && along.length) parts.push(`not periodic along ${listed(others)}`);
  return parts.join(", ");
}
