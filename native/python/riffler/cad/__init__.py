"""CAD files: STEP, IGES and BREP, read with OpenCASCADE in a process of its own (``pip install 'riffler[cad]'``).

`Mesh.read` reads them, too; `read` returns the faces, names and colours as well, and a report.
"""

from .part import CadBody, CadFace, CadPart, CadReport
from .process import CadReaderError
from .reading import KINDS, read

#: Extensions of the files that `read` reads.
EXTENSIONS = tuple(KINDS)

__all__ = ["EXTENSIONS", "CadBody", "CadFace", "CadPart", "CadReaderError", "CadReport", "read"]
