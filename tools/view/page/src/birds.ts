// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Many birds in one drawing: a small body with wings, placed, turned and lit for each. All are one
// mesh whose corners are placed here: browsers that emulate a graphics card draw instances one by
// one, which takes ten times as long. Where a flock's birds are few pixels wide, four faces are
// enough for each.

import * as THREE from 'three';

import { Shape, shadeOf, shadesOf } from './shape';

// Body x forward, y left, z up; wingspan 1.
const CORNERS = [
  [0.34, 0, 0.01], // 0 nose
  [-0.3, 0, 0.02], // 1 tail, 2 and 3 its ends
  [-0.4, 0.09, 0.02],
  [-0.4, -0.09, 0.02],
  [0.02, 0, 0.07], // 4 back, 5 belly
  [0.02, 0, -0.05],
  [0.04, 0.06, 0.03], // left wing: 6 and 7 at the body, 8 hand, 9 tip
  [-0.14, 0.05, 0.03],
  [0.1, 0.26, 0.07],
  [-0.1, 0.5, 0.09],
  [0.04, -0.06, 0.03], // right wing: 10 to 13, likewise
  [-0.14, -0.05, 0.03],
  [0.1, -0.26, 0.07],
  [-0.1, -0.5, 0.09],
];
const WHOLE = [
  [0, 6, 4], [0, 4, 10], [0, 5, 6], [0, 10, 5],
  [1, 4, 6], [1, 10, 4], [1, 6, 5], [1, 5, 10],
  [1, 2, 3],
  [6, 8, 7], [8, 9, 7],
  [10, 11, 12], [12, 11, 13],
];
const FAR = [
  [0, 2, 3], [0, 4, 5],
  [8, 9, 11], [12, 7, 13],
];
const FEW = 300; // birds that are always drawn whole
const SMALL = 22; // px of wingspan

// Faces as numbers in a row: normal, middle, and the corners.
const STRIDE = 15;
function facesOf(list: number[][]): Float64Array {
  const out = new Float64Array(STRIDE * list.length);
  list.forEach((face, k) => {
    const [a, b, c] = face.map((n) => new THREE.Vector3().fromArray(CORNERS[n]));
    const normal = b.clone().sub(a).cross(c.clone().sub(a)).normalize();
    const middle = a.clone().add(b).add(c).divideScalar(3);
    out.set([normal, middle, a, b, c].flatMap((v) => v.toArray()), STRIDE * k);
  });
  return out;
}
const FACES = { whole: facesOf(WHOLE), far: facesOf(FAR) };

// What a viewer sees of the flock, in its frame.
export interface Sight {
  eye: THREE.Vector3;
  up: THREE.Vector3;
  sun: THREE.Vector3; // towards it
  pixels: number; // that a length of 1 has in the middle of the flock
}

export class Birds {
  readonly shape: Shape;
  private sight: Sight | null = null;
  private faces = FACES.whole;

  constructor(most: number, opacity = 1) {
    this.shape = new Shape('triangles', 3 * WHOLE.length * Math.max(most, 1), opacity);
  }

  // Of about `birds` birds of a size.
  begin(sight: Sight, birds: number, size: number): void {
    this.sight = sight;
    this.faces = birds > FEW && size * sight.pixels < SMALL ? FACES.far : FACES.whole;
    this.shape.begin();
  }
  // Turned by the quaternion w, x, y, z: world from body, of any length.
  add(x: number, y: number, z: number, qw: number, qx: number, qy: number, qz: number, size: number,
    colour: string): void {
    const { faces, shape } = this;
    if (!this.sight || shape.room < faces.length / 5) return;
    const { eye, up, sun } = this.sight;
    const s = 2 / Math.max(qw * qw + qx * qx + qy * qy + qz * qz, 1e-12);
    const r00 = 1 - s * (qy * qy + qz * qz), r01 = s * (qx * qy - qz * qw), r02 = s * (qx * qz + qy * qw);
    const r10 = s * (qx * qy + qz * qw), r11 = 1 - s * (qx * qx + qz * qz), r12 = s * (qy * qz - qx * qw);
    const r20 = s * (qx * qz - qy * qw), r21 = s * (qy * qz + qx * qw), r22 = 1 - s * (qx * qx + qy * qy);
    // Eye, up and the sun as the bird sees them.
    const dx = (eye.x - x) / size, dy = (eye.y - y) / size, dz = (eye.z - z) / size;
    const ex = r00 * dx + r10 * dy + r20 * dz;
    const ey = r01 * dx + r11 * dy + r21 * dz;
    const ez = r02 * dx + r12 * dy + r22 * dz;
    const ux = r00 * up.x + r10 * up.y + r20 * up.z;
    const uy = r01 * up.x + r11 * up.y + r21 * up.z;
    const uz = r02 * up.x + r12 * up.y + r22 * up.z;
    const sx = r00 * sun.x + r10 * sun.y + r20 * sun.z;
    const sy = r01 * sun.x + r11 * sun.y + r21 * sun.z;
    const sz = r02 * sun.x + r12 * sun.y + r22 * sun.z;
    const { place, colour: paint } = shape;
    const shades = shadesOf(colour);
    let at = shape.count;
    for (let k = 0; k < faces.length; k += STRIDE) {
      const nx = faces[k], ny = faces[k + 1], nz = faces[k + 2];
      // The side that is seen is the one that is lit: by the sky more than by the ground, and by the sun.
      const side = nx * (ex - faces[k + 3]) + ny * (ey - faces[k + 4]) + nz * (ez - faces[k + 5]) < 0 ? -1 : 1;
      const toUp = side * (nx * ux + ny * uy + nz * uz);
      const toSun = side * (nx * sx + ny * sy + nz * sz);
      const shade = shades[shadeOf(toUp, toSun)];
      for (let c = k + 6; c < k + STRIDE; c += 3) {
        const cx = size * faces[c], cy = size * faces[c + 1], cz = size * faces[c + 2];
        place[3 * at] = x + r00 * cx + r01 * cy + r02 * cz;
        place[3 * at + 1] = y + r10 * cx + r11 * cy + r12 * cz;
        place[3 * at + 2] = z + r20 * cx + r21 * cy + r22 * cz;
        paint[at++] = shade;
      }
    }
    shape.count = at;
  }
  end(): void {
    this.shape.end();
  }
}
