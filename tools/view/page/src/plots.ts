// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A row of small plots side by side; those of which nothing is known are left out.

import uPlot from 'uplot';

import { ground } from './colours';

export interface PlotInfo {
  name: string;
  y?: [number, number]; // its range; else that of the data
}

export class Plots {
  readonly plots: uPlot[];
  private cells: HTMLElement[] = [];
  private words = document.createElement('p');
  private observer: ResizeObserver;

  constructor(
    private element: HTMLElement,
    infos: PlotInfo[],
    dark: boolean,
    series: uPlot.Series[], // of each plot
    rest: Partial<uPlot.Options>,
    nothing: string, // what is said when no plot is left
  ) {
    element.textContent = '';
    const colours = ground(dark);
    const fontSize = Math.round(parseFloat(getComputedStyle(element).fontSize) * 0.85);
    const axis = { stroke: colours.ink, grid: { stroke: colours.grid, width: 1 },
      font: `${fontSize}px system-ui, sans-serif`, ticks: { show: false } };
    // Lines grow with the type, so that they are seen on a large screen too.
    const type = parseFloat(getComputedStyle(document.documentElement).fontSize) / 13;
    const lines = series.map((line) => ({ ...line, width: type * (line.width ?? 1.5) }));
    this.words.className = 'no-curves';
    this.words.textContent = nothing;
    this.words.hidden = true;
    element.append(this.words);
    this.plots = infos.map(({ name, y }) => {
      const cell = document.createElement('div');
      cell.className = 'chart';
      const title = document.createElement('span');
      title.textContent = name;
      cell.append(title);
      element.append(cell);
      this.cells.push(cell);
      return new uPlot({
        ...this.size(infos.length),
        legend: { show: false },
        padding: [fontSize * 2.1, fontSize * 1.6, 0, 0],
        axes: [{ ...axis, size: fontSize * 1.9, space: 60 }, { ...axis, size: fontSize * 3.4, space: 28 }],
        series: [{}, ...lines],
        ...rest,
        scales: { x: { time: false, ...rest.scales?.x }, y: y ? { range: y } : {} },
      }, [[], ...series.map(() => [])] as uPlot.AlignedData, cell);
    });
    this.observer = new ResizeObserver(() => this.fit());
    this.observer.observe(element);
  }

  private size(shown: number): { width: number; height: number } {
    return {
      width: Math.max(Math.floor(this.element.clientWidth / Math.max(shown, 1)) - 6, 80),
      height: Math.max(this.element.clientHeight, 60),
    };
  }
  private fit(): void {
    const size = this.size(this.cells.filter((cell) => !cell.hidden).length);
    this.plots.forEach((plot) => plot.setSize(size));
  }

  set(all: uPlot.AlignedData[]): void {
    let differs = false;
    all.forEach((data, k) => {
      const empty = !data.slice(1).some((column) => [...column].some((y) => y !== null && y !== undefined));
      differs ||= this.cells[k].hidden !== empty;
      this.cells[k].hidden = empty;
      this.plots[k].setData(data);
    });
    this.words.hidden = !this.cells.every((cell) => cell.hidden);
    if (differs) this.fit();
  }

  destroy(): void {
    this.observer.disconnect();
    this.plots.forEach((plot) => plot.destroy());
  }
}
