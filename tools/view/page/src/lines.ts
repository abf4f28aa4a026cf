// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Many short lines in one drawing, filled anew for each frame.

import * as THREE from 'three';

export class Lines {
  readonly object: THREE.LineSegments;
  private positions: Float32Array;
  private colours: Float32Array;
  private count = 0; // vertices
  private known = new Map<string, THREE.Color>(); // what a colour's name is in numbers

  constructor(
    private most: number, // vertices
    opacity: number,
  ) {
    this.positions = new Float32Array(3 * most);
    this.colours = new Float32Array(3 * most);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(this.positions, 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(this.colours, 3));
    this.object = new THREE.LineSegments(
      geometry,
      new THREE.LineBasicMaterial({ vertexColors: true, transparent: opacity < 1, opacity }),
    );
    this.object.frustumCulled = false;
  }

  begin(): void {
    this.count = 0;
  }
  add(ax: number, ay: number, az: number, bx: number, by: number, bz: number, colour: string): void {
    if (this.count + 2 > this.most) return;
    let shade = this.known.get(colour);
    if (!shade) this.known.set(colour, (shade = new THREE.Color(colour)));
    const { positions, colours } = this;
    const at = 3 * this.count;
    positions[at] = ax;
    positions[at + 1] = ay;
    positions[at + 2] = az;
    positions[at + 3] = bx;
    positions[at + 4] = by;
    positions[at + 5] = bz;
    colours[at] = colours[at + 3] = shade.r;
    colours[at + 1] = colours[at + 4] = shade.g;
    colours[at + 2] = colours[at + 5] = shade.b;
    this.count += 2;
  }
  end(): void {
    const { geometry } = this.object;
    geometry.setDrawRange(0, this.count);
    this.object.visible = this.count > 0;
    if (this.count === 0) return;
    for (const name of ['position', 'color']) {
      const attribute = geometry.attributes[name] as THREE.BufferAttribute;
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, 3 * this.count);
      attribute.needsUpdate = true;
    }
  }
}
