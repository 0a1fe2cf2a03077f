// Makes the pictures of the documents: node pictures.mjs CUSP WEB TOP
import path from "node:path";
import { folder, openPage, pageOf, run, startBrowser, top } from "./browser.mjs";

const job = path.join(top, "examples", "demo", "pocket.toml"), program = path.join(folder, "pocket.ngc");
run("plan", job, "-o", program);
const { file } = pageOf(program, "--job", job, "--settings", path.join(top, "examples", "demo", "mill.settings"));
const browser = await startBrowser();
for (const { name, dark, colours, share } of [
  { name: "view.png", dark: false, colours: "height", share: 0.62 }, { name: "view-left.png", dark: true, colours: "left", share: 1 }]) {
  const { page } = await openPage(browser, file, { dark, width: 1400, height: 860 });
  await page.evaluate((show) => window.cusp.show(show), colours);
  const end = await page.evaluate(() => window.cusp.facts.duration_s);
  await page.evaluate((t) => window.cusp.seek(t), end * share);
  await page.waitForTimeout(1000);  // the finest lines
  await page.evaluate(() => window.cusp.seek(window.cusp.state().t_s));
  await page.screenshot({ path: path.join(top, "docs", "pictures", name) });
  console.log(`docs/pictures/${name}`);
}
// The studio in one file: a plate's drawing, suggested, planned and cut.
const { page } = await openPage(browser, path.join(top, "studio", "studio.html"), { width: 1400, height: 860 });
await page.locator("input[type=file]").setInputFiles([path.join(top, "examples", "plate", "plate.dxf")]);
await page.getByRole("navigation").getByRole("link", { name: "Operations" }).click();
await page.getByLabel("Tools", { exact: true }).fill("flat:6 drill:5 vee:6:60");
await page.getByLabel("Depth", { exact: true }).fill("6");
await page.getByLabel("Tabs", { exact: true }).fill("4");
await page.getByRole("button", { name: "Suggest" }).click();
await page.waitForFunction(() => window.cusp.state().job.includes("[[operation]]"));
await page.getByRole("navigation").getByRole("link", { name: "Check" }).click();
await page.getByRole("button", { name: "Plan", exact: true }).click();
await page.waitForFunction(() => window.cusp.state().checked);
await page.waitForTimeout(3000);  // the finest lines
await page.screenshot({ path: path.join(top, "docs", "pictures", "studio.png") });
console.log("docs/pictures/studio.png");
await browser.close();
