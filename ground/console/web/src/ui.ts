// Small helpers around the document.

type Child = Node | string | null | undefined | false;
type Props = Record<string, unknown>;

/** Makes an element: properties by name, `class`, `on...` handlers, `data-...` and `aria-...`. */
export function h<K extends keyof HTMLElementTagNameMap>(tag: K, props: Props = {}, ...children: Child[]):
    HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(props)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === "class") element.className = String(value);
    else if (name.startsWith("on")) element.addEventListener(name.slice(2), value as EventListener);
    else if (name.includes("-") || name === "role" || name === "for") element.setAttribute(name, String(value));
    else (element as unknown as Props)[name] = value;
  }
  add(element, ...children);
  return element;
}

export function add(element: Element, ...children: Child[]): void {
  for (const child of children) {
    if (child === null || child === undefined || child === false) continue;
    element.append(child);
  }
}

export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

export function show(element: HTMLElement, visible: boolean): void {
  element.hidden = !visible;
}

/** A row of buttons of which one is pressed. */
export function segmented<T extends string>(label: string, choices: readonly (readonly [T, string])[], current: T,
    choose: (value: T) => void): { element: HTMLElement; set: (value: T) => void } {
  const buttons = new Map<T, HTMLButtonElement>();
  const set = (value: T): void => {
    for (const [name, button] of buttons) button.setAttribute("aria-pressed", String(name === value));
  };
  const element = h("div", { class: "segmented", role: "group", "aria-label": label });
  for (const [value, text] of choices) {
    const button = h("button", { type: "button", onclick: () => { set(value); choose(value); } }, text);
    buttons.set(value, button);
    element.append(button);
  }
  set(current);
  return { element, set };
}

export function toggle(label: string, on: boolean, change: (on: boolean) => void):
    { element: HTMLElement; input: HTMLInputElement } {
  const input = h("input", { type: "checkbox", checked: on, role: "switch" });
  input.addEventListener("change", () => change(input.checked));
  return { element: h("label", { class: "toggle" }, input, h("span", { class: "knob", "aria-hidden": "true" }),
    h("span", {}, label)), input };
}

export function select(label: string, choices: readonly (readonly [string, string])[], current: string,
    choose: (value: string) => void): { element: HTMLElement; input: HTMLSelectElement } {
  const input = h("select", { "aria-label": label },
    ...choices.map(([value, text]) => h("option", { value, selected: value === current }, text)));
  input.addEventListener("change", () => choose(input.value));
  return { element: h("label", { class: "field" }, h("span", {}, label), input), input };
}

export function numberField(label: string, unit: string, value: number, step: number,
    change: (value: number) => void, range: { min?: number; max?: number } = {}):
    { element: HTMLElement; input: HTMLInputElement } {
  const input = h("input", { type: "number", inputMode: "decimal", step: String(step), value: String(value),
    min: range.min === undefined ? "" : String(range.min), max: range.max === undefined ? "" : String(range.max) });
  input.addEventListener("change", () => {
    const number = Number(input.value);
    if (input.value !== "" && Number.isFinite(number) && input.checkValidity()) change(number);
  });
  return { element: h("label", { class: "field" }, h("span", {}, label), h("span", { class: "with-unit" }, input,
    h("span", { class: "unit" }, unit))), input };
}

/** Remembers a setting of this browser. */
export function remember<T>(key: string, fallback: T): { get: () => T; set: (value: T) => void } {
  const name = `isotherm.${key}`;
  return {
    get: () => {
      try {
        const text = localStorage.getItem(name);
        return text === null ? fallback : JSON.parse(text) as T;
      } catch {
        return fallback;
      }
    },
    set: (value) => {
      try {
        localStorage.setItem(name, JSON.stringify(value));
      } catch {
        // A browser that keeps nothing still shows everything.
      }
    },
  };
}
