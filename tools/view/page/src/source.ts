// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where a run's data come from: the server, or what an exported page carries with it.

import { getBlob, getBytes, getJson } from './api';
import type { RunSession, Series } from './types';

export interface Source {
  session: RunSession;
  window(what: string, first: number, last: number, signal: AbortSignal): Promise<ArrayBuffer>;
  // The frame whose picture stands for `frame`: itself, or one before it of which there is one.
  pictured(frame: number): number;
  picture(frame: number, width: number, signal: AbortSignal): Promise<Blob>;
  series(what: string, animal: number): Promise<Series>;
}

export function serverSource(session: RunSession): Source {
  return {
    session,
    window: (what, first, last, signal) =>
      getBytes(`api/window?what=${what}&first=${first}&last=${last}`, signal),
    pictured: (frame) => frame,
    picture: (frame, width, signal) => getBlob(`frame/${frame}?width=${width}`, signal),
    series: (what, animal) =>
      getJson(`api/series?what=${what}` + (animal >= 0 ? `&animal=${animal}` : '')),
  };
}

// The exported page's data (tools/view/export_page.h): bytes in base 64.
interface Exported {
  session: RunSession;
  windowLength: number;
  windows: Record<string, string[]>; // what -> the window of each `windowLength` frames
  pictures: string[]; // JPEG, of frames 1, 1 + stride ..
  stride: number;
  series: Series;
}

function bytesOf(base64: string): ArrayBuffer {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; k++) bytes[k] = text.charCodeAt(k);
  return bytes.buffer;
}

export function exportedSource(): Source | null {
  const element = document.getElementById('flocklift-data');
  if (!element) return null;
  const data = JSON.parse(element.textContent ?? '') as Exported;
  return {
    session: { ...data.session, exported: true },
    window: (what, first) => {
      const list = data.windows[what] ?? [];
      const found = list[Math.floor(first / data.windowLength)];
      return found ? Promise.resolve(bytesOf(found)) : Promise.resolve(emptyWindow(first));
    },
    pictured: (frame) => frame - ((frame - 1) % data.stride),
    picture: (frame) => {
      const found = data.pictures[Math.floor((frame - 1) / data.stride)];
      return found
        ? Promise.resolve(new Blob([bytesOf(found)], { type: 'image/jpeg' }))
        : Promise.reject(new Error('the exported page has no picture of this frame'));
    },
    series: (_what, animal) =>
      animal < 0 ? Promise.resolve(data.series) : Promise.resolve(noSeries()),
  };
}

export const WINDOW_OF_EXPORT = 64;

function emptyWindow(first: number): ArrayBuffer {
  const words = new Uint32Array(9);
  words.set([0x574b4c46, 0, first, 0, 0]);
  return words.buffer;
}

export function noSeries(): Series {
  return { frames: [], depth: [], speed: [], neighbour: [], polarisation: [] };
}
