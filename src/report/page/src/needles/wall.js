// A wall in three dimensions: a sheet that needles can be seen through, with a lattice.
import * as three from "three";

const cells = 8; // along each edge

export class Wall {
  /** `axis`: to which it is normal; `kind`: what it is called. */
  constructor({ axis, kind }) {
    this.axis = axis;
    this.kind = kind;
    // Colours are as they are, as those of needles: no lights are computed.
    this.sheet = new three.Mesh(
      new three.PlaneGeometry(1, 1),
      new three.MeshBasicMaterial({ transparent: true, opacity: 0.16, side: three.DoubleSide, depthWrite: false, forceSinglePass: true }),
    );
    this.lattice = new three.LineSegments(latticeLines(), new three.LineBasicMaterial({ transparent: true, opacity: 0.55 }));
    // The plane is normal to z and is turned towards the axis; its edges then lie along the others.
    for (const part of this.parts) {
      if (axis === 0) part.rotation.set(0, Math.PI / 2, 0);
      if (axis === 1) part.rotation.set(Math.PI / 2, 0, 0);
    }
  }

  get parts() {
    return [this.sheet, this.lattice];
  }

  /** Its place along the axis, between corners whose middle is the origin. */
  place(place, low, high) {
    const size = high.map((end, n) => end - low[n]);
    const [along, up] = [[2, 1], [0, 2], [0, 1]][this.axis];
    for (const part of this.parts) {
      part.scale.set(size[along], size[up], 1);
      part.position.setComponent(this.axis, place - (low[this.axis] + high[this.axis]) / 2);
    }
  }

  colour(text) {
    for (const part of this.parts) part.material.color.setStyle(text);
  }
}

function latticeLines() {
  const ends = [];
  for (let n = 0; n <= cells; ++n) {
    const at = n / cells - 0.5;
    ends.push(at, -0.5, 0, at, 0.5, 0, -0.5, at, 0, 0.5, at, 0);
  }
  return new three.BufferGeometry().setAttribute("position", new three.Float32BufferAttribute(ends, 3));
}
