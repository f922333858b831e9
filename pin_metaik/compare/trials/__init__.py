"""What a trial is: the comparison it belongs to, the work item that holds it, the processes that run it, its row."""
