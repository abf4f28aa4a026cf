// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shapes drawn by the graphics card. One small shader does for all.

import { Matrix4, type PerspectiveCamera } from 'three';

import { inOrder, packed, resize, type Painter, type Placed, type Shape } from './shape';

const CORNER = `#version 300 es
in vec3 place;
in vec4 colour;
uniform mat4 transform;
flat out vec3 shade;
void main() {
  shade = colour.rgb;
  gl_Position = transform * vec4(place, 1.0);
}`;
const PIXEL = `#version 300 es
precision mediump float;
flat in vec3 shade;
uniform float opacity;
out vec4 pixel;
void main() {
  pixel = vec4(shade, opacity);
}`;

// A shape's corners on the card.
interface Corners {
  array: WebGLVertexArrayObject;
  place: WebGLBuffer;
  colour: WebGLBuffer;
  version: number;
}

export class GlPainter implements Painter {
  private gl: WebGL2RenderingContext;
  private kept = new Map<Shape, Corners>();
  private transform: WebGLUniformLocation | null = null;
  private opacity: WebGLUniformLocation | null = null;

  constructor(private canvas: HTMLCanvasElement) {
    const gl = canvas.getContext('webgl2', { alpha: false, antialias: true });
    if (!gl) throw new Error('the browser gives no WebGL 2 for another picture');
    this.gl = gl;
    this.start();
    // The browser may take the card away for a while, and all that was on it.
    canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => {
      this.kept.clear();
      this.start();
    });
  }

  private start(): void {
    const { gl } = this;
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, CORNER], [gl.FRAGMENT_SHADER, PIXEL]] as const) {
      const shader = gl.createShader(kind) as WebGLShader;
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, 'place');
    gl.bindAttribLocation(program, 1, 'colour');
    gl.linkProgram(program);
    gl.useProgram(program);
    this.transform = gl.getUniformLocation(program, 'transform');
    this.opacity = gl.getUniformLocation(program, 'opacity');
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  private make(shape: Shape): Corners {
    const { gl } = this;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const buffer = (at: number, bytes: number, describe: () => void) => {
      const made = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, made);
      gl.bufferData(gl.ARRAY_BUFFER, bytes, gl.DYNAMIC_DRAW);
      gl.enableVertexAttribArray(at);
      describe();
      return made;
    };
    const made = {
      array,
      place: buffer(0, shape.place.byteLength, () => gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0)),
      colour: buffer(1, shape.colour.byteLength, () => gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, 0, 0)),
      version: -1,
    };
    this.kept.set(shape, made);
    return made;
  }

  private forget(shape: Shape, { array, place, colour }: Corners): void {
    this.gl.deleteVertexArray(array);
    this.gl.deleteBuffer(place);
    this.gl.deleteBuffer(colour);
    this.kept.delete(shape);
  }

  paint(placed: Placed[], camera: PerspectiveCamera, back: string, width: number, height: number): void {
    const { gl, canvas } = this;
    resize(canvas, width, height);
    for (const [shape, corners] of this.kept) {
      if (!placed.some((one) => one.shape === shape)) this.forget(shape, corners);
    }
    const ground = packed(back);
    gl.viewport(0, 0, width, height);
    gl.depthMask(true);
    gl.clearColor((ground & 255) / 255, ((ground >> 8) & 255) / 255, ((ground >> 16) & 255) / 255, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    camera.updateMatrixWorld();
    const view = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    const all = new Matrix4();
    for (const { shape, matrix } of inOrder(placed)) {
      this.draw(shape, all.multiplyMatrices(view, matrix));
    }
  }

  private draw(shape: Shape, transform: Matrix4): void {
    const { gl } = this;
    const { count, opacity } = shape;
    const corners = this.kept.get(shape) ?? this.make(shape);
    gl.bindVertexArray(corners.array);
    if (corners.version !== shape.version) {
      corners.version = shape.version;
      gl.bindBuffer(gl.ARRAY_BUFFER, corners.place);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, shape.place, 0, 3 * count);
      gl.bindBuffer(gl.ARRAY_BUFFER, corners.colour);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, shape.colour, 0, count);
    }
    gl.uniformMatrix4fv(this.transform, false, transform.elements);
    gl.uniform1f(this.opacity, opacity);
    gl.depthMask(opacity === 1);
    if (opacity < 1) gl.enable(gl.BLEND);
    else gl.disable(gl.BLEND);
    gl.drawArrays(shape.kind === 'lines' ? gl.LINES : gl.TRIANGLES, 0, count);
  }
}
