# three.js, for the viewer's 3-D views: MESHORDER_THREE_JS is the file, of Debian's libjs-three.
find_file(
  MESHORDER_THREE_JS three.min.js
  PATHS /usr/share/javascript/three /usr/share/javascript/three/build
  DOC "three.js, release 111, for the page's 3-D views"
  NO_DEFAULT_PATH)
