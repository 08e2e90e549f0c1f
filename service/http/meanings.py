"""What each code means and what to do about it, for the person who sent the request."""

MEANINGS: dict[str, str] = {
    # Of a mesh: in the reply, or as the reason why a shape failed.
    "empty": "The file holds nothing. Export the mesh again and look at its size before you send it.",
    "no_mesh": "No .ply or .obj is among the files or in the zip. Send one, with whatever belongs to it.",
    "several_meshes": "There is more than one mesh. Send each in an upload of its own.",
    "not_ply": "The file is named .ply but is something else. Export it as PLY, or name it as what it is.",
    "not_obj": "The file is named .obj but is something else. Export it as OBJ, or name it as what it is.",
    "not_utf8": "The text is in an encoding that is not read. Save the file as UTF-8.",
    "unsupported": "The file is valid, but of a form that is not read, such as triangle strips. "
    "Export it with plain faces.",
    "bad_header": "The PLY header contradicts itself or lacks something. Export the mesh again.",
    "bad_data": "The data contradict the file's own header, or themselves. Export the mesh again.",
    "bad_number": "A word stands where a number should. Decimals need a point, not a comma.",
    "truncated": "The file ends before its own header says. It was cut on its way: copy or export it again.",
    "trailing_data": "The file goes on where its own header ends it. Export the mesh again.",
    "index_out_of_range": "A face names a vertex, or a texture coordinate, that is not there. "
    "Export the mesh again.",
    "non_finite": "A position or a texture coordinate is infinite or no number. Repair the mesh.",
    "no_faces": "The mesh has points or lines only. A surface is needed: make faces of a point cloud first.",
    "zero_area": "Nothing is left of the surface without its degenerate faces. Look at the mesh's scale.",
    "missing_texture": "The mesh names a material file or an image that was not sent. Send it along, "
    "or set `allow_untextured`.",
    "unsafe_reference": "A file name is absolute or points outside the upload. Use plain relative names.",
    "bad_image": "A texture cannot be read as an image. Save it as PNG or JPEG.",
    "image_too_large": "A texture has more pixels than allowed. Make it smaller.",
    "bad_archive": "The zip is damaged or encrypted, or holds links or another archive. Pack it anew.",
    "archive_too_large": "The zip unpacks to more than allowed. Send less in one upload.",
    "too_complex": "The mesh has too many faces, or needs more time or memory than allowed. Simplify it.",
    "unsolved": "The mesh's vibrations could not be computed with certainty. Repair or simplify the mesh.",
    "gave_up": "The work on this mesh ended again and again without a result, mostly for want of memory. "
    "Simplify the mesh; the service's log says more.",
    "unexpected": "The mesh met a defect of the service. Tell its operator, whose log says more.",
    # Of a form and what it holds.
    "bad_field": "A field of the form does not hold what it should; the detail says what is expected.",
    "bad_metadata": "Metadata are no JSON object, or hold what cannot be stored; the detail says where.",
    "bad_multipart": "The body breaks the rules of multipart/form-data. Let a library write the form.",
    "body_too_large": "The body is longer than allowed. Send less at once, or ask the operator for more.",
    "field_too_long": "A text field is longer than allowed. Shorten it.",
    "incomplete_body": "The body ended early, or its connection broke. Nothing was kept: send it again.",
    "no_files": "The form holds no file. Send the mesh in the field `files`, with its file name.",
    "not_multipart": "The body is no form. Send files as multipart/form-data.",
    "slow_body": "The body came too slowly. Nothing was kept: send it again over a better connection.",
    "too_many_files": "There are more files or fields than one upload may have. Send fewer, or a zip.",
    # Of a question.
    "bad_cursor": "The cursor is none of this list. Take `next_cursor` as it came, or begin without one.",
    "bad_weights": "The weights name a block that the method lacks, or are no numbers of use. "
    "`/v1/methods` lists the blocks.",
    "unknown_method": "No method has this name. `/v1/methods` lists them.",
    "not_explained": "The method compares what belongs to no one place on a surface, or the shape is kept "
    "too coarsely, so nothing can be coloured. Choose another method.",
    "not_ready": "The shape is not described yet, or failed. Wait until its status is `ready`.",
    "bad_block": "The shape's numbers do not fit this version. Index its files anew.",
    "fingerprint_mismatch": "The shape was described with other parameters than this version's. "
    "Index its files anew.",
    "no_vocabulary": "The library has no vocabulary yet. The operator makes one with "
    "`faience learn-vocabulary`.",
    "bad_vocabulary": "The library's vocabulary cannot be read, or not be learnt from its shapes. "
    "The operator learns one anew with `faience learn-vocabulary`.",
    "query_not_found": "Queries are remembered for an hour. Send the mesh again with `remember=true`.",
    "not_a_pair": "Both ids are the same. A shape is no duplicate of itself: name two shapes.",
    "not_dismissed": "Nobody said that these two shapes are no duplicates: there is nothing to take back.",
    "not_failed": "Only a shape that failed can be tried again. This one did not: there is nothing to do.",
    # Of who asks.
    "unauthorised": "A key is needed, and none came, or one that is not known. "
    "Send it as `Authorization: Bearer …`.",
    "read_only_key": "This key may look and search, not change. Use a key of scope `write`.",
    "foreign_host": "Without keys the service answers to this machine's own names only. "
    "The operator makes a key with `faience key create`.",
    "cross_origin": "A page of another site may not change the library. Use the service's own page.",
    "too_many_uploads": "This key sent more uploads than allowed in a minute. "
    "Go on after the seconds in `Retry-After`.",
    # Of the request as such.
    "bad_request": "The request is not well-formed: not HTTP, not JSON, or an impossible range of bytes. "
    "Let a library write it.",
    "invalid_request": "A parameter or the body is not as described. `errors` names each part "
    "and what it should be.",
    "not_found": "There is no such shape or address; it may have been removed. Look at the list of shapes.",
    "file_missing": "The shape has no such file, or not yet: pictures come when it is ready.",
    "method_not_allowed": "The address is right, the method is not. `Allow` names those that are.",
    "range_not_satisfiable": "The file has no such bytes. `Content-Range` says how long it is.",
    "headers_too_large": "The request's address and headers are too long. Shorten the query or the cookies.",
    "slow_request": "The head of the request did not end in time. Send it again over a better connection.",
    # Of the service.
    "busy": "The service or its catalogue has too much to do. Try again after the seconds in `Retry-After`.",
    "too_busy": "As many searches wait as may. Try again after the seconds in `Retry-After`.",
    "descriptions_changing": "All shapes are being described anew for a new version; what was asked "
    "needs that to be done. `/v1/queue` says how far it is.",
    "newer_descriptions": "A newer version of the service described this library anew, and this one is still "
    "running. The operator ends or updates it.",
    "vocabulary_changed": "The vocabulary changed during the search. "
    "Try again after the seconds in `Retry-After`.",
    "unready": "A part of the service cannot be used; `parts` says which and why. Send requests elsewhere "
    "until it is well.",
    "shutting_down": "This process was told to end. Send requests to another; those that come are still "
    "answered for a while.",
    "stopping": "The service is stopping. Try again when it is back.",
    "keys_unreadable": "The service cannot read its keys, so it lets nobody in. "
    "Try again in a moment; the operator finds more in the log.",
    "storage_full": "The disk is full; nothing of this request was kept. "
    "Remove shapes, or ask the operator for space.",
    "storage_unreachable": "The object storage that holds the files does not answer, or refuses. Nothing of "
    "this request was kept. Try again after the seconds in `Retry-After`; the operator's log says more.",
    "internal_error": "The service has a defect, and its log says more. Try again; tell its operator.",
}
