"""The program that reads CAD files. It runs in its own process; nothing else imports OpenCASCADE (``OCP``).

It needs Python, numpy and OCP, but neither riffler nor its extension module. So any Python that has these packages can
run it, not only the caller's.
"""
