"""CAD files: reads STEP, IGES and BREP with OpenCASCADE in a separate process (``pip install 'riffler[cad]'``).

`Mesh.read` reads them as well; `read` also returns faces, names and colours, and a report.
"""

from .part import CadBody, CadFace, CadPart, CadReport
from .process import CadReaderError
from .reading import KINDS, read

#: Extensions of the files that `read` reads.
EXTENSIONS = tuple(KINDS)

__all__ = ["EXTENSIONS", "CadBody", "CadFace", "CadPart", "CadReaderError", "CadReport", "read"]
