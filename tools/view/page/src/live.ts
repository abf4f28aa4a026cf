// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Looks at a running scene (tools/view/live_scene.h), read from a stream without end.

import { address } from './api';

export interface Look {
  agents: number;
  goals: Float32Array;
  time: number;
  looksPerSecond: number;
  stepsPerSecond: number;
  position: Float32Array;
  velocity: Int16Array;
  unit: number; // of velocity [m/s]
}

const MAGIC = 0x534b4c46;
const HEADER = 32;

export function lengthOf(header: DataView): number {
  if (header.getUint32(0, true) !== MAGIC) throw new Error('the server sent no look at the scene');
  const agents = header.getUint32(4, true);
  const goals = header.getUint32(8, true);
  return HEADER + 12 * goals + 12 * agents + 4 * Math.ceil((3 * agents) / 2);
}

function parse(bytes: ArrayBuffer): Look {
  const head = new DataView(bytes);
  const agents = head.getUint32(4, true);
  const goals = head.getUint32(8, true);
  return {
    agents,
    goals: new Float32Array(bytes, HEADER, 3 * goals),
    time: head.getFloat32(16, true),
    looksPerSecond: head.getFloat32(20, true),
    stepsPerSecond: head.getFloat32(24, true),
    unit: head.getFloat32(28, true),
    position: new Float32Array(bytes, HEADER + 12 * goals, 3 * agents),
    velocity: new Int16Array(bytes, HEADER + 12 * goals + 12 * agents, 3 * agents),
  };
}

// Calls `take` with the newest look; those that come while it is drawn are passed over.
export async function watchLive(take: (look: Look) => void): Promise<void> {
  const response = await fetch(address('api/live'));
  if (!response.ok || !response.body) throw new Error('the scene cannot be watched');
  const reader = response.body.getReader();
  let pieces: Uint8Array[] = [];
  let held = 0;
  let length = 0;
  let newest: ArrayBuffer | null = null;
  const gather = (size: number): Uint8Array => {
    const whole = new Uint8Array(size);
    let at = 0;
    while (at < size) {
      const piece = pieces[0];
      const part = piece.subarray(0, size - at);
      whole.set(part, at);
      at += part.length;
      if (part.length === piece.length) pieces.shift();
      else pieces[0] = piece.subarray(part.length);
    }
    held -= size;
    return whole;
  };
  let header: Uint8Array | null = null;
  const show = () => {
    if (newest) take(parse(newest));
    newest = null;
  };
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return;
    pieces.push(value);
    held += value.length;
    for (;;) {
      if (!header) {
        if (held < HEADER) break;
        header = gather(HEADER);
        length = lengthOf(new DataView(header.buffer));
      }
      if (held < length - HEADER) break;
      const whole = new Uint8Array(length);
      whole.set(header);
      whole.set(gather(length - HEADER), HEADER);
      header = null;
      if (!newest) requestAnimationFrame(show);
      newest = whole.buffer;
    }
  }
}
