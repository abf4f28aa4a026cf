// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Many birds in one drawing: a small body with wings, placed and turned for each. All are one mesh
// whose corners are placed here: browsers that emulate a graphics card draw instances one by one,
// which takes ten times as long.

import * as THREE from 'three';

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
const FACES = [
  [0, 6, 4], [0, 4, 10], [0, 5, 6], [0, 10, 5],
  [1, 4, 6], [1, 10, 4], [1, 6, 5], [1, 5, 10],
  [1, 2, 3],
  [6, 8, 7], [8, 9, 7],
  [10, 11, 12], [12, 11, 13],
];
const NUMBERS = 3 * CORNERS.length; // a bird's

export class Birds {
  readonly mesh: THREE.Mesh;
  private positions: THREE.BufferAttribute;
  private colours: THREE.BufferAttribute;
  private painted: string[] = []; // colour of each bird, as it stands in `colours`
  private repainted = false;
  private known = new Map<string, THREE.Color>(); // what a colour's name is in numbers
  private turn = new THREE.Matrix4();
  count = 0;

  constructor(
    private most: number,
    opacity = 1,
  ) {
    const birds = Math.max(most, 1);
    const attribute = () =>
      new THREE.BufferAttribute(new Float32Array(NUMBERS * birds), 3).setUsage(THREE.DynamicDrawUsage);
    this.positions = attribute();
    this.colours = attribute();
    const corners = FACES.flat();
    const index = new Uint32Array(corners.length * birds);
    for (let k = 0; k < birds; k++) {
      corners.forEach((c, n) => (index[k * corners.length + n] = k * CORNERS.length + c));
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', this.positions);
    geometry.setAttribute('color', this.colours);
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    const material = new THREE.MeshLambertMaterial({
      side: THREE.DoubleSide,
      flatShading: true,
      vertexColors: true,
      transparent: opacity < 1,
      opacity,
      depthWrite: opacity === 1,
    });
    this.mesh = new THREE.Mesh(geometry, material);
    this.mesh.frustumCulled = false;
  }

  begin(): void {
    this.count = 0;
    this.repainted = false;
  }
  add(x: number, y: number, z: number, q: THREE.Quaternion, size: number, colour: string): void {
    if (this.count >= this.most) return;
    const m = this.turn.makeRotationFromQuaternion(q).elements;
    const to = this.positions.array;
    let at = NUMBERS * this.count;
    for (const [forward, left, up] of CORNERS) {
      to[at++] = x + size * (m[0] * forward + m[4] * left + m[8] * up);
      to[at++] = y + size * (m[1] * forward + m[5] * left + m[9] * up);
      to[at++] = z + size * (m[2] * forward + m[6] * left + m[10] * up);
    }
    if (this.painted[this.count] !== colour) this.paint(this.count, colour);
    this.count++;
  }
  private paint(bird: number, colour: string): void {
    let shade = this.known.get(colour);
    if (!shade) this.known.set(colour, (shade = new THREE.Color(colour)));
    const to = this.colours.array;
    for (let at = NUMBERS * bird; at < NUMBERS * (bird + 1); at += 3) {
      to[at] = shade.r;
      to[at + 1] = shade.g;
      to[at + 2] = shade.b;
    }
    this.painted[bird] = colour;
    this.repainted = true;
  }
  end(): void {
    this.mesh.visible = this.count > 0;
    this.mesh.geometry.setDrawRange(0, 3 * FACES.length * this.count);
    if (this.count === 0) return;
    for (const changed of this.repainted ? [this.positions, this.colours] : [this.positions]) {
      changed.clearUpdateRanges();
      changed.addUpdateRange(0, NUMBERS * this.count);
      changed.needsUpdate = true;
    }
  }
}
