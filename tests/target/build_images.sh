#!/bin/sh
# Builds the images for the Cortex-M4F. usage: build_images.sh TOP
cd "$1" || exit 2
cmake --preset cortex-m4f >build/cortex-m4f.log 2>&1 || { cat build/cortex-m4f.log; exit 1; }
cmake --build --preset cortex-m4f >build/cortex-m4f.log 2>&1 || { cat build/cortex-m4f.log; exit 1; }
