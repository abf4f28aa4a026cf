// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A small run's folder, made from nothing: birds on known paths before a camera, and a film in which
// every frame shows its own number as bright and dark fields.

import { spawnSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

export const WIDTH = 640;
export const HEIGHT = 360;
export const FRAMES = 120;
export const BITS = 8;
export const FIELD = 16; // px
const FOCAL = 600;
const FPS = 30;

// World: the camera's own axes. Depth differs between birds and moves with time.
function positionOf(bird, frame) {
  const t = (frame - 1) / FPS;
  return [
    -6 + 4 * t + 1.5 * Math.sin(0.9 * t + bird) + 0.9 * (bird % 3),
    -1.5 + 1.6 * bird + 0.6 * Math.cos(1.1 * t + 2 * bird) - 2,
    24 + 3 * bird + 4 * Math.sin(0.7 * t + bird),
  ];
}

export function makeRun(folder, birds = 5) {
  mkdirSync(folder, { recursive: true });
  const frames = [];
  const rows = ['# fps=' + FPS];
  for (let f = 1; f <= FRAMES; f++) {
    const image = Buffer.alloc(WIDTH * HEIGHT, 190);
    const rect = (x0, y0, w, h, level) => {
      for (let y = Math.max(y0, 0); y < Math.min(y0 + h, HEIGHT); y++) {
        image.fill(level, y * WIDTH + Math.max(x0, 0), y * WIDTH + Math.min(Math.max(x0 + w, 0), WIDTH));
      }
    };
    for (let bit = 0; bit < BITS; bit++) rect(bit * FIELD, 0, FIELD, FIELD, (f >> bit) & 1 ? 235 : 20);
    for (let bird = 0; bird < birds; bird++) {
      const [x, y, z] = positionOf(bird, f);
      const u = (FOCAL * x) / z + WIDTH / 2;
      const v = (FOCAL * y) / z + HEIGHT / 2;
      const w = (FOCAL * 0.7) / z;
      if (u < 4 || u > WIDTH - 4 || v < 4 || v > HEIGHT - 4) continue;
      rect(Math.round(u - w / 2), Math.round(v - w / 4), Math.round(w), Math.round(w / 2), 50);
      rows.push(`${f},${bird + 1},${(u - w / 2).toFixed(3)},${(v - w / 4).toFixed(3)},${w.toFixed(3)},${(w / 2).toFixed(3)},1,-1,-1,-1`);
    }
    frames.push(image);
  }
  writeFileSync(join(folder, 'tracks.csv'), rows.join('\n') + '\n');
  writeFileSync(join(folder, 'camera.yaml'), `%YAML:1.0
---
image_width: ${WIDTH}
image_height: ${HEIGHT}
fps: ${FPS}
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ ${FOCAL}., 0., ${WIDTH / 2}., 0., ${FOCAL}., ${HEIGHT / 2}., 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ 0., 0., 0., 0., 0. ]
`);
  const video = join(folder, 'video.mp4');
  const made = spawnSync('ffmpeg', ['-y', '-loglevel', 'error', '-f', 'rawvideo', '-pix_fmt', 'gray',
    '-s', `${WIDTH}x${HEIGHT}`, '-r', String(FPS), '-i', '-', '-pix_fmt', 'yuv420p', '-g', '24',
    '-bf', '2', video], { input: Buffer.concat(frames), maxBuffer: 1 << 26 });
  if (made.status !== 0) throw new Error('ffmpeg: ' + made.stderr);
  writeFileSync(join(folder, 'summary.track.json'), JSON.stringify({ command: 'track', version: '0.1.0',
    options: {}, inputs: [{ name: video, sha256: '' }], outputs: [], figures: {} }));
  return video;
}
