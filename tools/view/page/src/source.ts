// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where a run's data come from: what the page carries with it, all of it if it was exported, else what
// the first picture needs; and the server.

import { getBlob, getBytes, getJson } from './api';
import type { RunSession, SceneSession, Series, Session } from './types';

export interface Source {
  session: RunSession;
  first: First;
  window(what: string, first: number, last: number, signal: AbortSignal): Promise<ArrayBuffer>;
  // The frame whose picture stands for `frame`: itself, or one before it of which there is one.
  pictured(frame: number): number;
  picture(frame: number, width: number, signal: AbortSignal): Promise<Blob>;
  series(what: string, animal: number): Promise<Series>;
}

// The rows of one frame, of a flock or the boxes, as the server packs them.
interface First {
  frame: number;
  rows: Record<string, ArrayBuffer>;
}
// What the server puts into the page (bytes in base 64).
interface Served {
  session: Session;
  first: { frame: number; rows: Record<string, string> };
}

function serverSource(session: RunSession, { frame, rows }: Served['first']): Source {
  const bytes = Object.entries(rows).map(([what, text]) => [what, bytesOf(text)] as const);
  return {
    session,
    first: { frame, rows: Object.fromEntries(bytes) },
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

// Not in every browser, and not in the compiler's list.
declare global {
  interface Uint8ArrayConstructor {
    fromBase64?(text: string): Uint8Array<ArrayBuffer>;
  }
}
function bytesOf(base64: string): ArrayBuffer {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64).buffer;
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; k++) bytes[k] = text.charCodeAt(k);
  return bytes.buffer;
}

// A run, or the scene that the server simulates.
export function source(): Source | SceneSession {
  const element = document.getElementById('flocklift-data');
  const data = JSON.parse(element?.textContent ?? '') as Served | Exported;
  if ('windows' in data) return exportedSource(data);
  return data.session.kind === 'run' ? serverSource(data.session, data.first) : data.session;
}

function exportedSource(data: Exported): Source {
  return {
    session: { ...data.session, exported: true },
    first: { frame: 0, rows: {} },
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
