// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Many birds in one drawing: a small body with wings, placed and turned for each.

import * as THREE from 'three';

// Body x forward, y left, z up; wingspan 1.
function birdGeometry(): THREE.BufferGeometry {
  const nose = [0.34, 0, 0.01];
  const tail = [-0.3, 0, 0.02];
  const tailLeft = [-0.4, 0.09, 0.02];
  const tailRight = [-0.4, -0.09, 0.02];
  const back = [0.02, 0, 0.07];
  const belly = [0.02, 0, -0.05];
  const left = [0.04, 0.06, 0.03];
  const right = [0.04, -0.06, 0.03];
  const leftBack = [-0.14, 0.05, 0.03];
  const rightBack = [-0.14, -0.05, 0.03];
  const leftTip = [-0.1, 0.5, 0.09];
  const rightTip = [-0.1, -0.5, 0.09];
  const leftHand = [0.1, 0.26, 0.07];
  const rightHand = [0.1, -0.26, 0.07];
  const faces = [
    [nose, left, back], [nose, back, right], [nose, belly, left], [nose, right, belly],
    [tail, back, left], [tail, right, back], [tail, left, belly], [tail, belly, right],
    [tail, tailLeft, tailRight],
    [left, leftHand, leftBack], [leftHand, leftTip, leftBack],
    [right, rightBack, rightHand], [rightHand, rightBack, rightTip],
  ];
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(faces.flat(2), 3));
  geometry.computeVertexNormals();
  return geometry;
}

export class Birds {
  readonly mesh: THREE.InstancedMesh;
  private matrix = new THREE.Matrix4();
  private known = new Map<string, THREE.Color>(); // what a colour's name is in numbers
  private position = new THREE.Vector3();
  private scale = new THREE.Vector3();
  count = 0;

  constructor(most: number, opacity = 1) {
    const material = new THREE.MeshLambertMaterial({
      side: THREE.DoubleSide,
      flatShading: true,
      transparent: opacity < 1,
      opacity,
      depthWrite: opacity === 1,
    });
    this.mesh = new THREE.InstancedMesh(birdGeometry(), material, Math.max(most, 1));
    this.mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.mesh.setColorAt(0, new THREE.Color());
  }

  begin(): void {
    this.count = 0;
  }
  add(x: number, y: number, z: number, q: THREE.Quaternion, size: number, colour: string): void {
    if (this.count >= this.mesh.instanceMatrix.count) return;
    this.matrix.compose(this.position.set(x, y, z), q, this.scale.set(size, size, size));
    this.mesh.setMatrixAt(this.count, this.matrix);
    let shade = this.known.get(colour);
    if (!shade) this.known.set(colour, (shade = new THREE.Color(colour)));
    this.mesh.setColorAt(this.count, shade);
    this.count++;
  }
  end(): void {
    this.mesh.count = this.count;
    this.mesh.instanceMatrix.needsUpdate = true;
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }
}
