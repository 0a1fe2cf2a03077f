// A screenshot of a page by an installed browser.
#pragma once

#include <string>

namespace cusp::view {

// The scene of a page of run_page() as PNG, 1600 x 1000 pixels, by headless Chromium.
//
// page  HTML file
//
// Throws InputError where no Chromium is found ($CHROMIUM, or chromium, chromium-browser, google-chrome
// on the path), or where it does not draw the page within two minutes.
std::string page_still(const std::string& page);

}  // namespace cusp::view
