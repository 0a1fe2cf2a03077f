// The page of one run.
import licences from "licences";

document.getElementById("app")!.textContent = licences;
