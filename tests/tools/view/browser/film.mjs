// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reads from the footage's pixels which frame it shows.

import { BITS, FIELD } from './make_run.mjs';
import { until } from './harness.mjs';

export const readFrame = (page) =>
  page.evaluate(({ bits, field }) => {
    const { footage } = window.flocklift;
    const t = footage.transform();
    const g = footage.sheet.getContext('2d');
    let number = 0;
    for (let bit = 0; bit < bits; bit++) {
      const x = Math.round(t.x + (bit + 0.5) * field * t.scale);
      const y = Math.round(t.y + 0.5 * field * t.scale);
      if (g.getImageData(x, y, 1, 1).data[0] > 128) number |= 1 << bit;
    }
    return number;
  }, { bits: BITS, field: FIELD });

// Goes to a frame and waits until the footage says that it is there.
export async function goTo(page, frame) {
  await page.evaluate((f) => window.flocklift.run.clock.go(f), frame);
  await until('frame ' + frame, () =>
    page.evaluate((f) => document.querySelector('.film canvas').dataset.frame === String(f), frame));
}
