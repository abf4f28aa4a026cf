// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A view into space: camera, light, ground grid in metres, and ways to look. The world is drawn with
// z up; where gravity is not known it is the film camera's axes, turned so that its up is up.

import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { ground } from './colours';
import { drawsInSoftware } from './graphics';
import { centreOf, poseAt } from './lens';
import type { ViewName } from './state';
import type { Bounds, CameraInfo } from './types';

// A round length: 1, 2 or 5 times a power of ten, about `length`.
export function roundLength(length: number): number {
  const power = 10 ** Math.floor(Math.log10(Math.max(length, 1e-6)));
  const digit = length / power;
  return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

export class Space {
  readonly scene = new THREE.Scene();
  readonly world = new THREE.Group(); // what is in the world frame
  readonly camera = new THREE.PerspectiveCamera(45, 1, 0.05, 20000);
  readonly renderer: THREE.WebGLRenderer;
  readonly controls: OrbitControls;
  readonly centre = new THREE.Vector3(); // of the flock, in the world frame
  extent = 10; // [m]
  gridStep = 1; // [m]
  private grid: THREE.GridHelper | null = null;
  private frustum: THREE.LineSegments | null = null;
  private view: ViewName = 'orbit';

  constructor(
    readonly canvas: HTMLCanvasElement,
    private film: CameraInfo | null,
    bounds: Bounds | null,
    upIsUp: boolean,
    private redraw: () => void,
  ) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !drawsInSoftware() });
    this.camera.up.set(0, 0, 1);
    if (!upIsUp) {
      // x right, y down, z forward  ->  x right, y forward, z up
      this.world.matrixAutoUpdate = false;
      this.world.matrix.set(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
      this.world.matrixWorldNeedsUpdate = true; // before it is first drawn, too
    }
    this.scene.add(this.world);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8899aa, 2.2));
    const sun = new THREE.DirectionalLight(0xffffff, 1.2);
    sun.position.set(0.4, -0.6, 1);
    this.scene.add(sun);
    if (bounds) {
      const low = new THREE.Vector3().fromArray(bounds.low);
      const high = new THREE.Vector3().fromArray(bounds.high);
      this.centre.addVectors(low, high).multiplyScalar(0.5);
      this.extent = Math.max(high.clone().sub(low).length(), 1);
    }
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', redraw);
    this.controls.zoomToCursor = true;
    new ResizeObserver(redraw).observe(canvas);
    this.look('orbit', 1);
  }

  toScene(v: THREE.Vector3): THREE.Vector3 {
    this.world.updateMatrixWorld();
    return v.applyMatrix4(this.world.matrixWorld);
  }

  paint(dark: boolean, showGrid: boolean): void {
    const colours = ground(dark);
    this.scene.background = new THREE.Color(colours.back);
    this.grid?.removeFromParent();
    this.gridStep = roundLength(this.extent / 12);
    const size = this.gridStep * 2 * Math.ceil((1.6 * this.extent) / this.gridStep / 2);
    this.grid = new THREE.GridHelper(size, size / this.gridStep, colours.ink, colours.grid);
    this.grid.rotation.x = Math.PI / 2;
    const middle = this.toScene(this.centre.clone());
    const snap = (x: number) => Math.round(x / this.gridStep) * this.gridStep;
    const floor = Math.min(0, middle.z - this.extent / 2);
    this.grid.position.set(snap(middle.x), snap(middle.y), snap(floor));
    this.grid.visible = showGrid;
    this.scene.add(this.grid);
    this.frustum?.removeFromParent();
    this.frustum = this.film ? this.makeFrustum(this.film, colours.ink) : null;
    if (this.frustum) this.world.add(this.frustum);
  }

  private makeFrustum(film: CameraInfo, colour: string): THREE.LineSegments {
    const d = 0.12 * this.extent;
    const corner = (u: number, v: number) =>
      new THREE.Vector3(((u - film.cx) / film.fx) * d, ((v - film.cy) / film.fy) * d, d);
    const c = [corner(0, 0), corner(film.width, 0), corner(film.width, film.height), corner(0, film.height)];
    const o = new THREE.Vector3();
    const points = [o, c[0], o, c[1], o, c[2], o, c[3], c[0], c[1], c[1], c[2], c[2], c[3], c[3], c[0]];
    const lines = new THREE.LineSegments(
      new THREE.BufferGeometry().setFromPoints(points),
      new THREE.LineBasicMaterial({ color: colour }),
    );
    lines.frustumCulled = false;
    lines.matrixAutoUpdate = false;
    return lines;
  }

  private worldFromFilm(frame: number): THREE.Matrix4 {
    const pose = poseAt(this.film as CameraInfo, frame);
    const m = new THREE.Matrix4();
    m.set(...(pose as [number, number, number, number, number, number, number, number, number,
      number, number, number]), 0, 0, 0, 1);
    return m.invert();
  }

  // Where to stand: around, above, beside, or at the film's camera.
  look(view: ViewName, frame: number): void {
    const middle = this.toScene(this.centre.clone());
    const far = 1.25 * this.extent;
    this.view = view;
    this.controls.enabled = view !== 'camera' && view !== 'follow';
    this.camera.fov = view === 'top' || view === 'side' ? 12 : 45;
    const away = view === 'top' || view === 'side' ? (far * 45) / 12 : far;
    const from = new THREE.Vector3(0.75, -1, 0.55).normalize();
    if (this.film && view !== 'camera') {
      // Aside of the film's own line of sight, where depth is seen.
      const eye = this.toScene(new THREE.Vector3(...centreOf(poseAt(this.film, frame))));
      const line = middle.clone().sub(eye).setZ(0).normalize();
      const right = new THREE.Vector3(line.y, -line.x, 0);
      if (line.lengthSq() > 0.5) {
        from.copy(right).multiplyScalar(0.85).addScaledVector(line, -0.7).setZ(0.5).normalize();
        if (view === 'side') from.copy(right);
      }
    } else if (view === 'side') {
      from.set(0, -1, 0);
    }
    if (view === 'top') from.set(0, -1e-4, 1);
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).addScaledVector(from, away);
    this.camera.up.set(0, 0, 1);
    this.controls.update();
    this.redraw();
  }

  // Behind an animal and above it, flying along.
  follow(position: THREE.Vector3, velocity: THREE.Vector3, size: number): void {
    const back = velocity.clone().normalize();
    const away = Math.max(9 * size, 0.05 * this.extent);
    const wanted = position.clone().addScaledVector(back, -away);
    wanted.z += 0.35 * away;
    this.camera.position.lerp(wanted, this.camera.position.distanceTo(wanted) > 4 * away ? 1 : 0.15);
    this.controls.target.copy(position);
    this.camera.lookAt(position);
  }

  // Places the camera for a frame; what faces the viewer is placed after it.
  aim(frame: number): void {
    const { canvas, camera } = this;
    camera.aspect = Math.max(canvas.clientWidth, 1) / Math.max(canvas.clientHeight, 1);
    camera.near = this.extent / 2000;
    camera.far = 60 * this.extent;
    if (this.frustum) {
      this.frustum.matrix.copy(this.worldFromFilm(frame));
      this.frustum.visible = this.view !== 'camera';
    }
    if (this.view === 'camera' && this.film) this.placeAtFilm(frame);
    else camera.updateProjectionMatrix();
  }

  render(): void {
    const { canvas, renderer } = this;
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    if (width === 0 || height === 0) return;
    const size = renderer.getSize(new THREE.Vector2());
    renderer.setPixelRatio(Math.min(devicePixelRatio, drawsInSoftware() ? 1 : 2));
    if (size.x !== width || size.y !== height) renderer.setSize(width, height, false);
    renderer.render(this.scene, this.camera);
  }

  // The film's own view: its pose, and its intrinsics as the projection, letter-boxed.
  private placeAtFilm(frame: number): void {
    const film = this.film as CameraInfo;
    const { camera } = this;
    const flip = new THREE.Matrix4().makeScale(1, -1, -1); // OpenCV's axes to OpenGL's
    const pose = this.world.matrixWorld.clone().multiply(this.worldFromFilm(frame)).multiply(flip);
    pose.decompose(camera.position, camera.quaternion, camera.scale);
    const aspect = camera.aspect;
    const w = Math.max(film.width, film.height * aspect);
    const h = w / aspect;
    const left = film.cx + (w - film.width) / 2;
    const top = film.cy + (h - film.height) / 2;
    const n = camera.near;
    camera.projectionMatrix.makePerspective(
      (-left * n) / film.fx, ((w - left) * n) / film.fx,
      (top * n) / film.fy, (-(h - top) * n) / film.fy, n, camera.far,
    );
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  }

  // A place of the canvas (CSS px) in the plane through `through` that faces the viewer, or
  // the level one; world frame.
  toPlane(x: number, y: number, through: THREE.Vector3, level: boolean): THREE.Vector3 | null {
    const ray = new THREE.Raycaster();
    const at = new THREE.Vector2((2 * x) / this.canvas.clientWidth - 1,
      1 - (2 * y) / this.canvas.clientHeight);
    ray.setFromCamera(at, this.camera);
    const normal = level
      ? new THREE.Vector3(0, 0, 1)
      : this.camera.getWorldDirection(new THREE.Vector3());
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, through);
    const hit = ray.ray.intersectPlane(plane, new THREE.Vector3());
    if (!hit) return null;
    this.world.updateMatrixWorld();
    return hit.applyMatrix4(this.world.matrixWorld.clone().invert());
  }

  // Where a point of the world is on the canvas [CSS px].
  onCanvas(x: number, y: number, z: number): [number, number] | null {
    const p = this.toScene(new THREE.Vector3(x, y, z)).project(this.camera);
    if (p.z > 1 || p.z < -1) return null;
    return [((p.x + 1) / 2) * this.canvas.clientWidth, ((1 - p.y) / 2) * this.canvas.clientHeight];
  }
}
