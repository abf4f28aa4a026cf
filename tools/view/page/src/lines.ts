// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Many short lines, and discs that face the viewer.

import * as THREE from 'three';

import { Shape, packed } from './shape';

export class Lines {
  readonly shape: Shape;

  constructor(most: number, opacity: number) {
    this.shape = new Shape('lines', 2 * most, opacity);
  }
  begin(): void {
    this.shape.begin();
  }
  end(): void {
    this.shape.end();
  }
  add(ax: number, ay: number, az: number, bx: number, by: number, bz: number, colour: string): void {
    if (this.shape.room < 2) return;
    const ink = packed(colour);
    this.shape.add(ax, ay, az, ink);
    this.shape.add(bx, by, bz, ink);
  }
}

const CORNERS = 40; // of a disc's edge

export class Discs {
  readonly shape: Shape;

  constructor(most: number, opacity: number) {
    this.shape = new Shape('triangles', 6 * CORNERS * most, opacity);
  }
  begin(): void {
    this.shape.begin();
  }
  end(): void {
    this.shape.end();
  }
  // Between two radii, in the plane of `right` and `up`, which are unit lengths at right angles.
  add(centre: THREE.Vector3, right: THREE.Vector3, up: THREE.Vector3, inner: number, outer: number,
    colour: string): void {
    if (this.shape.room < 6 * CORNERS) return;
    const ink = packed(colour);
    const corner = (k: number, radius: number) => {
      const [c, s] = [radius * Math.cos((2 * Math.PI * k) / CORNERS), radius * Math.sin((2 * Math.PI * k) / CORNERS)];
      this.shape.add(centre.x + c * right.x + s * up.x, centre.y + c * right.y + s * up.y,
        centre.z + c * right.z + s * up.z, ink);
    };
    for (let k = 0; k < CORNERS; k++) {
      corner(k, inner), corner(k, outer), corner(k + 1, outer);
      corner(k, inner), corner(k + 1, outer), corner(k + 1, inner);
    }
  }
}
