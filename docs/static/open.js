/* Folds the parts of a long page on a phone; opens the one to which a link leads, and all for print. */
function fold_parts() {
  if (matchMedia("(max-width: 46em)").matches)
    document.querySelectorAll("details.part").forEach((each, k) => (each.open = k === 0));
}
function open_target() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  const content = target.tagName === "DT" ? target.parentElement.querySelector(":scope > dd") : target;
  for (let each = content.querySelector(":scope > details") || target; each; each = each.parentElement)
    if (each.tagName === "DETAILS") each.open = true;
  target.scrollIntoView({ behavior: "instant" });
}
addEventListener("DOMContentLoaded", () => (fold_parts(), open_target()));
addEventListener("hashchange", open_target);
addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((each) => (each.open = true)));
