// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shapes drawn by the graphics card. One small shader does for all.

import * as THREE from 'three';

import type { Painter, Shape } from './shape';

const CORNER = `
in vec3 position;
in vec4 color;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
flat out vec3 shade;
void main() {
  shade = color.rgb;
  gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));
}`;
const PIXEL = `
precision mediump float;
flat in vec3 shade;
uniform float opacity;
out vec4 pixel;
void main() {
  pixel = vec4(shade, opacity);
}`;

interface Drawn {
  object: THREE.Mesh | THREE.LineSegments;
  version: number;
}

export class GlPainter implements Painter {
  private renderer: THREE.WebGLRenderer;
  private scene = new THREE.Scene();
  private drawn = new Map<Shape, Drawn>();

  constructor(canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
  }

  private make(shape: Shape): Drawn {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(shape.place, 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(new Uint8Array(shape.colour.buffer), 4, true));
    const material = new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: CORNER, fragmentShader: PIXEL,
      uniforms: { opacity: { value: shape.opacity } }, side: THREE.DoubleSide,
      transparent: shape.opacity < 1, depthWrite: shape.opacity === 1,
    });
    const object = shape.kind === 'lines'
      ? new THREE.LineSegments(geometry, material)
      : new THREE.Mesh(geometry, material);
    object.frustumCulled = false;
    object.matrixAutoUpdate = false;
    this.scene.add(object);
    const made = { object, version: -1 };
    this.drawn.set(shape, made);
    return made;
  }

  paint(shapes: { shape: Shape; matrix: THREE.Matrix4 }[], camera: THREE.PerspectiveCamera,
    back: string, width: number, height: number, ratio: number): void {
    const kept = new Set(shapes.map(({ shape }) => shape));
    for (const [shape, { object }] of this.drawn) {
      if (kept.has(shape)) continue;
      object.removeFromParent();
      object.geometry.dispose();
      this.drawn.delete(shape);
    }
    shapes.forEach(({ shape, matrix }, order) => {
      const drawn = this.drawn.get(shape) ?? this.make(shape);
      const { object } = drawn;
      object.visible = shape.visible && shape.count > 0;
      object.renderOrder = order;
      object.matrix.copy(matrix);
      object.matrixWorldNeedsUpdate = true;
      object.geometry.setDrawRange(0, shape.count);
      if (drawn.version === shape.version || !object.visible) return;
      drawn.version = shape.version;
      for (const name of ['position', 'color']) {
        const attribute = object.geometry.attributes[name] as THREE.BufferAttribute;
        attribute.clearUpdateRanges();
        attribute.addUpdateRange(0, shape.count * attribute.itemSize);
        attribute.needsUpdate = true;
      }
    });
    const size = this.renderer.getSize(new THREE.Vector2());
    this.renderer.setPixelRatio(ratio);
    if (size.x !== width || size.y !== height) this.renderer.setSize(width, height, false);
    this.renderer.setClearColor(back);
    this.renderer.render(this.scene, camera);
  }
}
