"""The program that reads CAD files: it runs in a process of its own and alone imports OpenCASCADE (``OCP``).

It needs Python, numpy and OCP, but neither riffler nor its extension module: any Python that has the extra can run it,
not only the caller's.
"""
