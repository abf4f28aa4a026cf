// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Brings in the parts that come after the first picture (later.ts), with which the page shares
// preact.

import * as preact from 'preact';
import * as hooks from 'preact/hooks';
import * as runtime from 'preact/jsx-runtime';

import type { Parts } from './later';

declare global {
  interface Window {
    flockliftShared?: Record<string, unknown>;
    flockliftParts?: Parts;
  }
}

// The page carries the script's text in an element that runs nothing.
export function bringParts(): Parts {
  if (!window.flockliftParts) {
    window.flockliftShared = { preact, 'preact/hooks': hooks, 'preact/jsx-runtime': runtime };
    const script = document.createElement('script');
    script.text = document.getElementById('flocklift-later')?.textContent ?? '';
    document.head.append(script);
  }
  return window.flockliftParts as unknown as Parts;
}
