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
  private colour = new THREE.Color();

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
    this.positions.set([ax, ay, az, bx, by, bz], 3 * this.count);
    const { r, g, b } = this.colour.set(colour);
    this.colours.set([r, g, b, r, g, b], 3 * this.count);
    this.count += 2;
  }
  end(): void {
    const { geometry } = this.object;
    geometry.setDrawRange(0, this.count);
    (geometry.attributes.position as THREE.BufferAttribute).needsUpdate = true;
    (geometry.attributes.color as THREE.BufferAttribute).needsUpdate = true;
  }
}
