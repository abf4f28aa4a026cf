// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The last half minute of a running scene as curves.

import { useEffect, useRef } from 'preact/hooks';
import type uPlot from 'uplot';

import { colourOf } from './colours';
import type { LiveSeries } from './liveSeries';
import { Plots, type PlotInfo } from './plots';
import { useValue, type Store } from './state';

const CURVES: PlotInfo[] = [
  { name: 'polarisation', y: [-0.02, 1.05] },
  { name: 'mean speed [m/s]' },
  { name: 'spread [m]' },
  { name: 'mean distance to the goal [m]' },
];

export function LiveCharts({ series, store }: { series: LiveSeries; store: Store }) {
  const host = useRef<HTMLDivElement>(null);
  const dark = useValue(store, (s) => s.dark);
  useEffect(() => {
    const element = host.current;
    if (!element) return;
    const plots = new Plots(element, CURVES, dark,
      [{ stroke: colourOf(0, dark), width: 1.4, points: { show: false } }],
      { cursor: { show: false } }, '');
    let waiting = false;
    series.listener = () => {
      if (waiting) return;
      waiting = true;
      requestAnimationFrame(() => {
        waiting = false;
        plots.set(CURVES.map((_, k) =>
          [series.columns[0], series.columns[k + 1]] as uPlot.AlignedData));
      });
    };
    return () => {
      series.listener = null;
      plots.destroy();
    };
  }, [dark]);
  return <div class="charts" ref={host} />;
}
