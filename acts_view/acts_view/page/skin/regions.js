// Of a hand: what each region feels, and what the hand is about.

const FULL_N = 5;

export class Regions {
  constructor(element) {
    this.element = element;
    element.innerHTML = `<h3>Hand <span class="state"></span></h3><p class="reason"></p><ul></ul>`;
    this.rows = new Map();
  }

  /** The newest of both; hidden as long as neither is published. */
  show(regions, hand) {
    this.element.hidden = !regions.length && !hand.state;
    this.#text(this.element.querySelector(".state"), [hand.state, ...(hand.active ?? [])].filter(Boolean).join(" · "));
    this.#text(this.element.querySelector(".reason"), hand.reason ?? "");
    for (const [name, force_n, slip_m, isSlipping] of regions) {
      const row = this.#row(name);
      row.dataset.slipping = isSlipping;
      row.querySelector("i").style.transform = `scaleX(${Math.min(force_n / FULL_N, 1)})`;
      this.#text(row.querySelector(".force"), `${force_n.toFixed(2)} N`);
      this.#text(row.querySelector(".slip"), isSlipping ? `slips ${(1000 * slip_m).toFixed(1)} mm` : "");
    }
  }

  #row(name) {
    if (!this.rows.has(name)) {
      const row = document.createElement("li");
      row.innerHTML = `<span class="name"></span><span class="bar-of-force"><i></i></span><span class="force"></span><span class="slip"></span>`;
      row.querySelector(".name").textContent = name.replaceAll("_", " ");
      this.element.querySelector("ul").append(row);
      this.rows.set(name, row);
    }
    return this.rows.get(name);
  }

  #text(element, text) {
    if (element.textContent !== text) element.textContent = text;
  }
}
