// A guided scene on the page: its words, its steps, and the question at its end.

import { formula, html } from "./charts.js";
import { SCENES } from "./scenes.js";

export class Story {
  /** `page` has the page's state, shows a step's row, plays it, and hears when the scene has ended. */
  constructor(place, page) {
    this.place = place;
    this.page = page;
    this.scene = null;
    this.step = 0;
  }

  async begin(id) {
    this.scene = SCENES.find((one) => one.id === id) ?? null;
    if (this.scene) await this.go(0);
    else this.end();
  }

  /** A step's row follows from all steps before it, so that any can be opened by itself. */
  async go(at) {
    this.step = at;
    const { steps } = this.scene;
    const upTo = steps.slice(0, at + 1);
    const from = upTo.findLastIndex((one) => one.preset);
    const edits = upTo.slice(from).flatMap((one) => one.edits ?? []);
    const view = Object.assign({ curveView: "tof", whole: false, reference: null }, ...upTo.slice(from).map((one) => one.view ?? {}));
    await this.page.show(upTo[from].preset, edits, view);
    this.tell();
    if (steps[at].view?.play) this.page.playFromStart();
  }

  end() {
    this.scene = null;
    this.place.hidden = true;
    this.page.ended();
  }

  /** Shows the scene's words, with the numbers of the moment. */
  tell() {
    const { place, scene, step } = this;
    place.hidden = !scene;
    if (!scene) return;
    const last = step === scene.steps.length - 1;
    const words = scene.steps[step].text;
    const text = typeof words === "function" ? words(this.page.state) : words;
    const key = JSON.stringify([scene.id, step, text]);
    if (place.dataset.key === key) return;
    const opened = place.dataset.answer === scene.id + step;
    const focused = place.contains(document.activeElement) ? document.activeElement.dataset.go : null;
    place.dataset.key = key;
    const button = (name, act, of, primary) => html("button", { type: "button", "data-go": of, class: primary ? "primary" : undefined, onclick: act }, name);
    const answer = html("p", { class: "answer", hidden: !opened }, formula(scene.answer));
    const asking = last ? [html("p", { class: "question" }, scene.question), answer] : [];
    const show = () => {
      answer.hidden = false;
      place.dataset.answer = scene.id + step;
    };
    place.replaceChildren(html("h2", {}, scene.title), html("p", {}, formula(text)), ...asking, html("div", { class: "steps" }, [
      button("Back", () => this.go(step - 1), "back"),
      last ? button("Show an answer", show, "next", true) : button("Next", () => this.go(step + 1), "next", true),
      html("span", {}, `${step + 1} of ${scene.steps.length}`),
      button("End the scene", () => this.end(), "end"),
    ]));
    place.querySelector("[data-go=back]").disabled = step === 0;
    if (focused) (place.querySelector(`[data-go=${focused}]:not(:disabled)`) ?? place.querySelector("[data-go=next]")).focus();
  }
}
