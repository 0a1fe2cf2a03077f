#!/bin/sh
# Makes a wheel of the module that a build has made. It has no reader of STEP and IGES.
# usage: wheel.sh PYTHON BUILD-FOLDER VERSION OUTPUT-FOLDER
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tree=$work/cusp-$3
info=$tree/cusp-$3.dist-info
mkdir -p "$info"
cp -R "$2/python/cusp" "$tree/cusp"
rm -rf "$tree/cusp/libcusp_cad.so" "$tree/cusp/__pycache__"
strip --strip-unneeded "$tree"/cusp/_cusp.*.so
tag=$("$1" -c 'import sys, sysconfig; v = "cp%d%d" % sys.version_info[:2]
print(v + "-" + v + "-" + sysconfig.get_platform().replace("-", "_").replace(".", "_"))')
cat >"$info/WHEEL" <<EOF
Wheel-Version: 1.0
Generator: cusp
Root-Is-Purelib: false
Tag: $tag
EOF
cat >"$info/METADATA" <<EOF
Metadata-Version: 2.1
Name: cusp
Version: $3
Summary: Tool paths with proven bounds, their verification, and the motion of the controller that runs them
Requires-Python: >=3.9
Requires-Dist: numpy
EOF
mkdir -p "$4"
"$1" -m wheel pack "$tree" --dest-dir "$4"
